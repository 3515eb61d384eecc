#include "edge_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bilinear.h"

namespace tartan_calib::detection {
namespace {

constexpr double kMinArmMatch = 0.88;    ///< cosine between the edge as followed and the arm that it arrives at
constexpr double kMinSupport = 0.2;      ///< light minus dark across the edge, in units of the saddle's contrast
constexpr int kMaxUnsupportedSteps = 2;  ///< in a row; more is the end of the edge
constexpr int kTaps = 5;                 ///< samples across the edge
constexpr double kOffsetGain = 0.6;      ///< share of the measured offset that a step corrects
constexpr double kTurnGain = 0.25;       ///< share of the corrected step that turns the direction

/// Saddles by square cells of the image.
class SaddleIndex {
 public:
  SaddleIndex(const std::vector<Saddle>& saddles, const cv::Size& size)
      : saddles_(saddles), columns_(size.width / kCell_px + 1), rows_(size.height / kCell_px + 1) {
    first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1);
    next_.assign(saddles.size(), -1);
    for (int i = static_cast<int>(saddles.size()) - 1; i >= 0; --i) {
      const Eigen::Vector2d& px = saddles[static_cast<std::size_t>(i)].px;
      int& head = first_[cell(cellOf(px.x(), columns_), cellOf(px.y(), rows_))];
      next_[static_cast<std::size_t>(i)] = head;
      head = i;
    }
  }

  /// Calls visit(index) for the saddles of all cells that a disc touches.
  template <typename Visitor>
  void visitNear(const Eigen::Vector2d& px, double radius_px, const Visitor& visit) const {
    const int last_column = cellOf(px.x() + radius_px, columns_);
    const int last_row = cellOf(px.y() + radius_px, rows_);
    for (int row = cellOf(px.y() - radius_px, rows_); row <= last_row; ++row) {
      for (int column = cellOf(px.x() - radius_px, columns_); column <= last_column; ++column) {
        for (int i = first_[cell(column, row)]; i >= 0; i = next_[static_cast<std::size_t>(i)]) {
          visit(i);
        }
      }
    }
  }

 private:
  static constexpr int kCell_px = 8;

  static int cellOf(double coordinate_px, int num_cells) {
    return std::clamp(static_cast<int>(coordinate_px) / kCell_px, 0, num_cells - 1);
  }
  std::size_t cell(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  const std::vector<Saddle>& saddles_;
  int columns_;
  int rows_;
  std::vector<int> first_;
  std::vector<int> next_;
};

/// Grey values across an edge, from its dark to its light side.
struct CrossSection {
  double support;    ///< light minus dark
  double offset_px;  ///< of the steepest part, towards the light side
};

class EdgeTracer {
 public:
  EdgeTracer(const cv::Mat& gray, const std::vector<Saddle>& saddles)
      : gray_(gray), saddles_(saddles), index_(saddles, gray.size()) {
    for (const Saddle& saddle : saddles) {
      std::array<Eigen::Vector2d, 4> directions;
      for (std::size_t arm = 0; arm < 4; ++arm) {
        directions[arm] = {std::cos(saddle.arm_rad[arm]), std::sin(saddle.arm_rad[arm])};
      }
      arm_directions_.push_back(directions);
    }
  }

  /// The arm of another saddle at which the edge that leaves by `arm` arrives.
  ArmLink follow(int from, int arm) const {
    const Saddle& start = saddles_[static_cast<std::size_t>(from)];
    const double step_px = 1.5 * start.scale_px;
    const double max_length_px = gray_.cols + gray_.rows;
    // Seen along an even arm, dark lies clockwise, to the right.
    const double to_light = arm % 2 == 0 ? -1.0 : 1.0;
    Eigen::Vector2d direction = arm_directions_[static_cast<std::size_t>(from)][static_cast<std::size_t>(arm)];
    Eigen::Vector2d px = start.px + kFirstStep * start.scale_px * direction;
    int unsupported = 0;
    for (double length_px = kFirstStep * start.scale_px; length_px < max_length_px; length_px += step_px) {
      const ArmLink link = arrival(from, arm, px, direction);
      if (link.saddle_index >= 0) {
        return link;
      }
      const Eigen::Vector2d light = to_light * Eigen::Vector2d(-direction.y(), direction.x());
      const auto section = crossSection(px, light, start.scale_px);
      if (!section) {
        return {};
      }
      unsupported = section->support < kMinSupport * start.contrast ? unsupported + 1 : 0;
      if (unsupported > kMaxUnsupportedSteps) {
        return {};
      }
      if (unsupported == 0) {
        const Eigen::Vector2d correction = kOffsetGain * section->offset_px * light;
        px += correction;
        direction = (direction + kTurnGain * correction / step_px).normalized();
      }
      px += step_px * direction;
    }
    return {};
  }

 private:
  static constexpr double kFirstStep = 2.0;      ///< [steps]; nearer to the junction all four wedges mix
  static constexpr double kArrivalRadius = 1.5;  ///< [scale] plus kArrivalSlack_px
  static constexpr double kArrivalSlack_px = 0.5;

  /// A saddle close to `px` with an arm that points back along the edge.
  ArmLink arrival(int from, int arm, const Eigen::Vector2d& px, const Eigen::Vector2d& direction) const {
    const double from_scale_px = saddles_[static_cast<std::size_t>(from)].scale_px;
    constexpr double kLargestScale_px = 8.0;
    ArmLink best;
    double best_distance_px2 = std::numeric_limits<double>::max();
    index_.visitNear(px, kArrivalRadius * std::min(kLargestScale_px, 2.0 * from_scale_px) + kArrivalSlack_px, [&](int i) {
      const Saddle& candidate = saddles_[static_cast<std::size_t>(i)];
      const double distance_px2 = (candidate.px - px).squaredNorm();
      const double radius_px = kArrivalRadius * std::max(from_scale_px, candidate.scale_px) + kArrivalSlack_px;
      if (i == from || distance_px2 > radius_px * radius_px || distance_px2 >= best_distance_px2) {
        return;
      }
      for (const int back_arm : {1 - arm % 2, 3 - arm % 2}) {
        const Eigen::Vector2d& back = arm_directions_[static_cast<std::size_t>(i)][static_cast<std::size_t>(back_arm)];
        if (-back.dot(direction) > kMinArmMatch) {
          best = {i, back_arm};
          best_distance_px2 = distance_px2;
        }
      }
    });
    return best;
  }

  std::optional<CrossSection> crossSection(const Eigen::Vector2d& px, const Eigen::Vector2d& light,
                                           double spacing_px) const {
    constexpr int kMiddle = kTaps / 2;
    const Eigen::Vector2d reach = (kMiddle * spacing_px) * light;
    if (!canSample(gray_, px.x() - std::abs(reach.x()), px.y() - std::abs(reach.y())) ||
        !canSample(gray_, px.x() + std::abs(reach.x()), px.y() + std::abs(reach.y()))) {
      return std::nullopt;
    }
    std::array<float, kTaps> gray{};
    for (int k = 0; k < kTaps; ++k) {
      const Eigen::Vector2d at = px + ((k - kMiddle) * spacing_px) * light;
      gray[static_cast<std::size_t>(k)] = sampleBilinear(gray_, at.x(), at.y());
    }
    float slope_sum = 0.0F;
    float moment = 0.0F;
    for (int k = 0; k + 1 < kTaps; ++k) {
      const float slope = std::max(0.0F, gray[static_cast<std::size_t>(k + 1)] - gray[static_cast<std::size_t>(k)]);
      slope_sum += slope;
      moment += slope * (static_cast<float>(k - kMiddle) + 0.5F);
    }
    const float offset = slope_sum > 0.0F ? moment / slope_sum : 0.0F;
    return CrossSection{static_cast<double>(gray[kMiddle + 1] - gray[kMiddle - 1]),
                        spacing_px * static_cast<double>(offset)};
  }

  const cv::Mat& gray_;
  const std::vector<Saddle>& saddles_;
  SaddleIndex index_;
  std::vector<std::array<Eigen::Vector2d, 4>> arm_directions_;
};

}  // namespace

std::vector<ArmLinks> linkSaddles(const cv::Mat& gray, const std::vector<Saddle>& saddles) {
  const EdgeTracer tracer(gray, saddles);
  std::vector<ArmLinks> found(saddles.size());
  for (std::size_t i = 0; i < saddles.size(); ++i) {
    for (int arm = 0; arm < 4; ++arm) {
      found[i][static_cast<std::size_t>(arm)] = tracer.follow(static_cast<int>(i), arm);
    }
  }
  // A link that only one end found stands where the other end found nothing else.
  std::vector<ArmLinks> links(saddles.size());
  const auto at = [](std::vector<ArmLinks>& all, const ArmLink& end) -> ArmLink& {
    return all[static_cast<std::size_t>(end.saddle_index)][static_cast<std::size_t>(end.arm)];
  };
  for (const bool mutual : {true, false}) {
    for (std::size_t i = 0; i < saddles.size(); ++i) {
      for (int arm = 0; arm < 4; ++arm) {
        const ArmLink here{static_cast<int>(i), arm};
        const ArmLink there = at(found, here);
        if (there.saddle_index < 0 || at(links, here).saddle_index >= 0 || at(links, there).saddle_index >= 0) {
          continue;
        }
        const ArmLink back = at(found, there);
        const bool is_mutual = back.saddle_index == here.saddle_index && back.arm == here.arm;
        if (mutual ? is_mutual : back.saddle_index < 0) {
          at(links, here) = there;
          at(links, there) = here;
        }
      }
    }
  }
  return links;
}

}  // namespace tartan_calib::detection
