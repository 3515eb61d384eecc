#include "calibration_options_yaml.h"

#include "number_text.h"
#include "target_text.h"

namespace tartan_calib::io {
namespace {

using calibration::LinearSolver;
using pipeline::CalibrateOptions;

constexpr double kSecondsPerNanosecond = 1e-9;

std::string yamlBool(bool value) { return value ? "true" : "false"; }

std::string linearSolverName(LinearSolver solver) {
  switch (solver) {
    case LinearSolver::kAuto:
      return "auto";
    case LinearSolver::kSchur:
      return "schur";
    case LinearSolver::kSparse:
      return "sparse";
  }
  return "";
}

std::string refinementName(detection::Refinement refinement) {
  switch (refinement) {
    case detection::Refinement::kSymmetry:
      return "symmetry";
    case detection::Refinement::kAdaptive:
      return "adaptive";
    case detection::Refinement::kFixed:
      return "fixed";
  }
  return "";
}

void addRefinementOptions(YamlWriter& yaml, const detection::RecoveryOptions& recovery) {
  yaml.open("refinement");
  yaml.add("method", refinementName(recovery.refinement));
  yaml.add("symmetry_window", yamlFloat(recovery.symmetry_window));
  yaml.add("window_scale", yamlFloat(recovery.adaptive_window.scale));
  yaml.add("min_half_window_px", std::to_string(recovery.adaptive_window.min_half_window_px));
  yaml.add("max_half_window_px", std::to_string(recovery.adaptive_window.max_half_window_px));
  yaml.close();
}

void addSolveOptions(YamlWriter& yaml, const calibration::SolveOptions& solve) {
  yaml.open("solve");
  yaml.add("linear_solver", linearSolverName(solve.linear_solver));
  yaml.add("max_iterations", std::to_string(solve.max_iterations));
  yaml.add("fix_intrinsics", yamlBool(solve.fix_intrinsics));
  yaml.add("fix_extrinsics", yamlBool(solve.fix_extrinsics));
  yaml.add("fixed_cameras", yamlFlow(solve.fixed_cameras));
  yaml.add("estimate_board_warp", yamlBool(solve.estimate_board_warp));
  yaml.add("estimate_pupil_shift", yamlBool(solve.estimate_pupil_shift));
  yaml.add("anneal_robust_loss", yamlBool(solve.anneal_robust_loss));
  yaml.add("use_blake_zisserman", yamlBool(solve.use_blake_zisserman));
  yaml.add("remove_outliers", yamlBool(solve.remove_outliers));
  yaml.add("outlier_sigma", yamlFloat(solve.outlier_sigma));
  yaml.add("min_views_outlier", std::to_string(solve.min_views_outlier));
  yaml.add("final_filtering", yamlBool(solve.final_filtering));
  yaml.close();
}

/// Every virtual view as [width, height, fu, fv, cu, cv, rows of R_cam_view].
void addProjections(YamlWriter& yaml, const pipeline::Projections& projections) {
  constexpr int kNumNumbers = 15;
  if (projections.rectified) {
    yaml.add("rectified_view", yamlFlow(std::vector<int>{projections.rectified->width, projections.rectified->height}));
  }
  if (projections.pinholes.empty()) {
    return;
  }
  yaml.open("pinhole_views");
  for (const pipeline::VirtualPinhole& pinhole : projections.pinholes) {
    const Eigen::Matrix3d columns_are_rows = pinhole.R_cam_view.transpose();
    Eigen::VectorXd numbers(kNumNumbers);
    numbers << pinhole.width, pinhole.height, pinhole.focal_px, pinhole.centre_px,
        Eigen::Map<const Eigen::VectorXd>(columns_are_rows.data(), columns_are_rows.size());
    yaml.item(yamlFlow(numbers));
  }
  yaml.close();
}

}  // namespace

void addOptions(YamlWriter& yaml, const CalibrateOptions& options, const target::Target& target) {
  yaml.open("options");
  yaml.add("models", yamlFlow(options.models));
  yaml.add("focal_hint_px", options.focal_hint_px ? yamlFloat(*options.focal_hint_px) : "null");
  yaml.add("has_known_rig", yamlBool(options.known_rig.has_value()));
  if (const auto* grid = std::get_if<target::AprilGrid>(&target)) {
    yaml.add("min_tags", std::to_string(options.min_tags.value_or(pipeline::minTags(*grid))));
  }
  yaml.add("approx_sync_s", yamlFloat(static_cast<double>(options.approx_sync_ns) * kSecondsPerNanosecond));
  yaml.add("max_rounds", std::to_string(options.max_rounds));
  const bool is_by_quads = options.recovery.filter == detection::CornerFilter::kQuads;
  yaml.add("corner_filter", is_by_quads ? "quads" : "image");
  if (is_by_quads) {
    yaml.add("max_quad_distance_px", yamlFloat(options.recovery.max_quad_distance_px));
  }
  addProjections(yaml, options.projections);
  yaml.open("detector");
  yaml.add("min_border_distance_px", yamlFloat(options.detector.min_border_distance_px));
  yaml.add("max_hamming", std::to_string(options.detector.max_hamming));
  yaml.add("max_refine_shift_px", yamlFloat(options.detector.max_refine_shift_px));
  yaml.close();
  addRefinementOptions(yaml, options.recovery);
  addSolveOptions(yaml, options.solve);
  yaml.close();
}

void addTarget(YamlWriter& yaml, const target::Target& target) {
  yaml.open("target");
  addTargetKeys(yaml, target);
  yaml.close();
}

}  // namespace tartan_calib::io
