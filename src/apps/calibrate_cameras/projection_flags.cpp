#include "calibrate_cameras/projection_flags.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/program.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

constexpr double kRadiansPerDegree = 0.017453292519943295;
constexpr double kMaxFov_deg = 175.0;  ///< a plane grows without bound towards 180
constexpr int kMinSize_px = 50;        ///< smaller views show no tag
constexpr int kMaxSize_px = 8192;

/// Values of one flag: column i belongs to projection i.
struct Columns {
  std::vector<double> first_row;
  std::vector<double> second_row;
};

/// The defaults, which are TartanCalib's, where the flag is absent.
Columns columnsFrom(const Flags& flags, const std::string& name, std::size_t num_projections, const Columns& defaults) {
  if (!flags.has(name)) {
    return {std::vector<double>(num_projections, defaults.first_row.front()),
            std::vector<double>(num_projections, defaults.second_row.front())};
  }
  const auto values = flags.get<std::vector<double>>(name);
  if (values.size() != 2 * num_projections) {
    throw UsageError("--" + name + " needs two rows with one value for each of the " + std::to_string(num_projections) +
                     " --projections, such as --" + name + " 90 ... --" + name + " 90 ...; it has " +
                     std::to_string(values.size()) + " values");
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(num_projections);
  return {{values.begin(), middle}, {middle, values.end()}};
}

double fov_rad(double fov_deg) {
  if (!(fov_deg > 0.0 && fov_deg <= kMaxFov_deg)) {
    throw UsageError("--fovs takes angles above 0 and up to " + std::to_string(static_cast<int>(kMaxFov_deg)) +
                     " degrees: a plane shows no more");
  }
  return fov_deg * kRadiansPerDegree;
}

int size_px(double value) {
  if (!(value >= kMinSize_px && value <= kMaxSize_px && std::floor(value) == value)) {
    throw UsageError("--resolutions takes whole pixels from " + std::to_string(kMinSize_px) + " to " +
                     std::to_string(kMaxSize_px));
  }
  return static_cast<int>(value);
}

}  // namespace

pipeline::Projections projectionsFrom(const Flags& flags) {
  pipeline::Projections projections;
  const auto names = flags.get<std::vector<std::string>>("projections");
  for (const std::string name : {"fovs", "poses", "resolutions"}) {
    if (flags.has(name) && names.empty()) {
      throw UsageError("--" + name + " describes the views of --projections, which is missing");
    }
  }
  const Columns fovs_deg = columnsFrom(flags, "fovs", names.size(), {{90.0}, {90.0}});
  const Columns poses_deg = columnsFrom(flags, "poses", names.size(), {{90.0}, {0.0}});
  const Columns sizes_px = columnsFrom(flags, "resolutions", names.size(), {{1000.0}, {1000.0}});
  for (std::size_t i = 0; i < names.size(); ++i) {
    const pipeline::ViewSize size{fov_rad(fovs_deg.first_row[i]), fov_rad(fovs_deg.second_row[i]),
                                  size_px(sizes_px.second_row[i]), size_px(sizes_px.first_row[i])};
    if (names[i] == "pinhole") {
      projections.pinholes.push_back(pipeline::pinholeView(size, poses_deg.first_row[i] * kRadiansPerDegree,
                                                           poses_deg.second_row[i] * kRadiansPerDegree));
    } else if (names[i] == "cube") {
      const auto faces = pipeline::cubeViews(size);
      projections.pinholes.insert(projections.pinholes.end(), faces.begin(), faces.end());
    } else if (names[i] == "homography") {
      projections.rectified = size;
    } else if (names[i] != "cornerpredictor" && names[i] != "none") {
      throw UsageError(
          "--projections takes pinhole, cube, homography, cornerpredictor (what the rounds do anyway) and none, not '" +
          names[i] + "'");
    }
  }
  return projections;
}

std::vector<std::string> notesOnProjections(const Flags& flags) {
  struct ViewFlag {
    const char* name;
    std::vector<std::string> owners;
  };
  const std::vector<ViewFlag> view_flags = {
      {"fovs", {"pinhole", "cube"}}, {"poses", {"pinhole"}}, {"resolutions", {"pinhole", "cube", "homography"}}};
  const auto names = flags.get<std::vector<std::string>>("projections");
  std::vector<std::string> notes;
  for (const ViewFlag& flag : view_flags) {
    const bool is_owned =
        std::find_first_of(names.begin(), names.end(), flag.owners.begin(), flag.owners.end()) != names.end();
    if (flags.has(flag.name) && !is_owned) {
      notes.push_back("--" + std::string(flag.name) + " has no effect: it describes views of --projections " +
                      joined(flag.owners));
    }
  }
  return notes;
}

}  // namespace tartan_calib::apps
