#pragma once

#include <Eigen/Core>
#include <limits>

namespace tartan_calib::camera {

using Matrix23d = Eigen::Matrix<double, 2, 3>;

/// A central camera model: a `Shape` that maps directions to the plane, then focal lengths and principal point.
///
///   m = shape(p_cam),  u = fu * m.x + cu,  v = fv * m.y + cv
///
/// Camera frame: x right, y down, z forward. Pixel (0, 0) is the centre of the first pixel. Parameters are in Kalibr's
/// order: the shape's leading parameters, fu, fv, cu, cv, the shape's trailing parameters (the distortion).
///
/// A Shape is a small class with
///   kName, kKalibrModel, kKalibrDistortion   names on the command line and in camchain files
///   kNumLeading, kNumTrailing                its numbers of parameters before and after the focal lengths
///   Parameters                               Eigen vector [leading, trailing]
///   Shape(const Parameters&)
///   start(), lowerBound(), upperBound()      static; start() is a shape from which any lens can be fitted
///   bool project(p, m, J_m_p, J_m_shape)     false where p has no image; Jacobians may be null
///   bool unproject(m, ray)                   false where m is no image of any direction; ray need not be unit
template <class Shape>
class Model {
 public:
  static constexpr const char* kName = Shape::kName;
  static constexpr const char* kKalibrModel = Shape::kKalibrModel;
  static constexpr const char* kKalibrDistortion = Shape::kKalibrDistortion;
  static constexpr int kNumIntrinsics = Shape::kNumLeading + 4;
  static constexpr int kNumDistortion = Shape::kNumTrailing;
  static constexpr int kNumParameters = kNumIntrinsics + kNumDistortion;
  static constexpr int kFocalIndex = Shape::kNumLeading;  ///< fu, then fv, cu, cv

  using Parameters = Eigen::Matrix<double, kNumParameters, 1>;
  using ParameterJacobian = Eigen::Matrix<double, 2, kNumParameters>;

  Model() : Model(start(1.0, Eigen::Vector2d::Zero())) {}
  explicit Model(const Parameters& parameters) : parameters_(parameters), shape_(shapeParameters(parameters)) {}

  const Parameters& parameters() const { return parameters_; }

  /// Projects a point in the camera frame (any scale) to pixels; may lie outside of the image. False, and `px` untouched,
  /// where the model gives the point no image. J_px_pcam = d(px)/d(p_cam), J_px_parameters = d(px)/d(parameters).
  bool project(const Eigen::Vector3d& p_cam, Eigen::Vector2d& px, Matrix23d* J_px_pcam = nullptr,
               ParameterJacobian* J_px_parameters = nullptr) const;

  /// Unit ray in the camera frame of a pixel. False where the model has no ray for it.
  bool unproject(const Eigen::Vector2d& px, Eigen::Vector3d& ray_cam) const;

  /// Parameters whose image scale in the centre is `focal_px` pixels per radian.
  static Parameters start(double focal_px, const Eigen::Vector2d& principal_point_px);

  /// Box in which the solver keeps the parameters; unbounded ones are +-infinity.
  static Parameters lowerBound();
  static Parameters upperBound();

 private:
  static typename Shape::Parameters shapeParameters(const Parameters& parameters) {
    typename Shape::Parameters shape;
    shape << parameters.template head<Shape::kNumLeading>(), parameters.template tail<Shape::kNumTrailing>();
    return shape;
  }
  static Parameters joined(const typename Shape::Parameters& shape, const Eigen::Vector4d& pinhole) {
    Parameters parameters;
    parameters << shape.template head<Shape::kNumLeading>(), pinhole, shape.template tail<Shape::kNumTrailing>();
    return parameters;
  }

  Parameters parameters_;
  Shape shape_;
};

template <class Shape>
bool Model<Shape>::project(const Eigen::Vector3d& p_cam, Eigen::Vector2d& px, Matrix23d* J_px_pcam,
                           ParameterJacobian* J_px_parameters) const {
  Eigen::Vector2d m;
  Matrix23d J_m_p;
  Eigen::Matrix<double, 2, Shape::kNumLeading + Shape::kNumTrailing> J_m_shape;
  if (!shape_.project(p_cam, m, J_px_pcam != nullptr ? &J_m_p : nullptr,
                      J_px_parameters != nullptr ? &J_m_shape : nullptr)) {
    return false;
  }
  const Eigen::Vector2d focal_px = parameters_.template segment<2>(kFocalIndex);
  px = focal_px.cwiseProduct(m) + parameters_.template segment<2>(kFocalIndex + 2);
  if (J_px_pcam != nullptr) {
    *J_px_pcam = focal_px.asDiagonal() * J_m_p;
  }
  if (J_px_parameters != nullptr) {
    J_px_parameters->template leftCols<Shape::kNumLeading>() =
        focal_px.asDiagonal() * J_m_shape.template leftCols<Shape::kNumLeading>();
    J_px_parameters->template middleCols<4>(kFocalIndex) << m.x(), 0.0, 1.0, 0.0, 0.0, m.y(), 0.0, 1.0;
    J_px_parameters->template rightCols<Shape::kNumTrailing>() =
        focal_px.asDiagonal() * J_m_shape.template rightCols<Shape::kNumTrailing>();
  }
  return true;
}

template <class Shape>
bool Model<Shape>::unproject(const Eigen::Vector2d& px, Eigen::Vector3d& ray_cam) const {
  const Eigen::Vector2d m =
      (px - parameters_.template segment<2>(kFocalIndex + 2)).cwiseQuotient(parameters_.template segment<2>(kFocalIndex));
  Eigen::Vector3d ray;
  if (!shape_.unproject(m, ray)) {
    return false;
  }
  ray_cam = ray.normalized();
  return true;
}

template <class Shape>
typename Model<Shape>::Parameters Model<Shape>::start(double focal_px, const Eigen::Vector2d& principal_point_px) {
  const typename Shape::Parameters shape = Shape::start();
  Eigen::Vector2d m;
  Matrix23d J_m_p;
  Shape(shape).project(Eigen::Vector3d::UnitZ(), m, &J_m_p, nullptr);
  const double focal = focal_px / J_m_p(0, 0);
  return joined(shape, Eigen::Vector4d(focal, focal, principal_point_px.x(), principal_point_px.y()));
}

template <class Shape>
typename Model<Shape>::Parameters Model<Shape>::lowerBound() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return joined(Shape::lowerBound(), Eigen::Vector4d(1.0, 1.0, -kInfinity, -kInfinity));
}

template <class Shape>
typename Model<Shape>::Parameters Model<Shape>::upperBound() {
  return joined(Shape::upperBound(), Eigen::Vector4d::Constant(std::numeric_limits<double>::infinity()));
}

}  // namespace tartan_calib::camera
