#include "simulate/simulate.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>

#include "common/interrupt.h"
#include "simulate/recording_writer.h"
#include "simulate/truth.h"
#include "tartan_calib/io/target_yaml.h"
#include "tartan_calib/simulation/lens.h"
#include "tartan_calib/simulation/recording.h"
#include "tartan_calib/simulation/renderer.h"
#include "tartan_calib/threads.h"

namespace tartan_calib::apps {
namespace {

/// The default camera's noise, scaled to `noise_grey` at half of full scale.
simulation::SensorOptions sensor(const SimulateOptions& options) {
  constexpr double kHalfScaleGrey = 127.5;
  simulation::SensorOptions sensor;
  const double own_variance = sensor.read_noise_grey * sensor.read_noise_grey + sensor.shot_noise_grey * kHalfScaleGrey;
  const double variance_ratio = options.noise_grey * options.noise_grey / own_variance;
  sensor.psf_sigma_px = options.psf_sigma_px;
  sensor.read_noise_grey *= std::sqrt(variance_ratio);
  sensor.shot_noise_grey *= variance_ratio;
  return sensor;
}

std::vector<simulation::SceneCamera> lenses(const SimulateOptions& options) {
  std::vector<simulation::SceneCamera> lenses;
  for (int k = 0; k < options.num_cameras; ++k) {
    const std::size_t model_index = options.models.size() == 1 ? 0 : static_cast<std::size_t>(k);
    const simulation::LensRequest request{options.lens, options.models[model_index], options.width, options.height};
    const std::uint64_t piece_seed = options.seed * static_cast<std::uint64_t>(options.num_cameras) + lenses.size();
    lenses.push_back(simulation::anotherPiece(simulation::makeLens(request), piece_seed));
  }
  return lenses;
}

std::string truthBase(const SimulateOptions& options) {
  namespace fs = std::filesystem;
  const fs::path path(options.output_bag.empty() ? options.output_dir : options.output_bag);
  const fs::path named = path.has_filename() ? path : path.parent_path();
  return options.output_bag.empty() ? named.string() : fs::path(named).replace_extension().string();
}

}  // namespace

simulation::Scene makeScene(const SimulateOptions& options) {
  constexpr double kRadPerDegree = M_PI / 180.0;
  constexpr double kSecondsPerMs = 1e-3;
  simulation::RecordingOptions recording;
  if (!options.target_file.empty()) {
    recording.target = io::loadTarget(options.target_file).target;
  }
  recording.cameras =
      simulation::makeRig(lenses(options), options.baseline_m, options.yaw_deg * kRadPerDegree, options.seed);
  for (std::size_t k = 0; k < recording.cameras.size(); ++k) {
    recording.cameras[k].delay_s = kSecondsPerMs * options.delay_ms * static_cast<double>(k);
  }
  recording.num_frames = options.num_views;
  recording.reach_ratio = options.reach_ratio;
  if (options.tilt_deg) {
    recording.max_tilt_rad = *options.tilt_deg * kRadPerDegree;
  }
  recording.rate_hz = options.rate_hz;
  recording.blurred_ratio = options.blurred_ratio;
  recording.max_blur_px = options.max_blur_px;
  recording.hand_ratio = options.hand_ratio;
  recording.exposure_ratio = options.exposure_ratio;
  recording.sensor = sensor(options);
  recording.seed = options.seed;
  return simulation::makeRecording(recording);
}

SimulateSummary simulate(const SimulateOptions& options, const ProgressCall& progress) {
  const simulation::Renderer renderer(makeScene(options));
  const UninterruptedSection all_or_nothing;
  const std::unique_ptr<RecordingWriter> writer =
      options.output_bag.empty() ? makeFolderWriter(options.output_dir) : makeBagWriter(options.output_bag);
  Truth truth(renderer.scene());
  SimulateSummary summary;
  const std::size_t num_frames = renderer.scene().frames.size();
  std::size_t num_rendered = 0;
  const auto tell = [&] {
    if (progress) {
      progress(num_rendered, num_frames);
    }
  };
  tell();
  cv::setNumThreads(1);  // threads work on frames
  const auto receive = [&](const simulation::RenderedFrame& frame) {
    writer->write(frame);
    truth.add(frame);
    summary.num_images += frame.views.size();
    ++num_rendered;
    tell();
  };
  simulation::renderAll(renderer, numThreads(options.num_threads), receive, throwIfInterrupted);
  summary.base = truthBase(options);
  summary.num_corners = truth.numCorners();
  summary.num_visible_corners = truth.numVisibleCorners();
  truth.save(summary.base);
  writer->finish();
  setFinishedWork(options.output_bag + options.output_dir + " and its truth are written");
  return summary;
}

}  // namespace tartan_calib::apps
