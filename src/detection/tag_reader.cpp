#include "tag_reader.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bitset>
#include <cmath>

#include "bilinear.h"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define TARTAN_CALIB_POPCOUNT __attribute__((target_clones("popcnt", "default")))
#else
#define TARTAN_CALIB_POPCOUNT
#endif

namespace tartan_calib::detection {
namespace {

constexpr double kMinContrast = 6.0;         ///< between paper and border [grey levels]
constexpr double kMinDarkBorderShare = 0.8;  ///< of the border's samples
constexpr double kMinLightGapShare = 0.8;    ///< of the samples around the tag
/// Strengths of sharpening: the share of the difference to the four neighbouring cells that is added. A bit of three is
/// what a blur of half a cell takes away.
constexpr std::array<double, 3> kSharpenings = {0.0, 0.5, 1.0};

/// Grey values over the plane of the tag, gray = a + b u + c v, by least squares: light is rarely even.
class ShadePlane {
 public:
  void add(const Eigen::Vector2d& uv, double gray) {
    const Eigen::Vector3d basis(1.0, uv.x() - 0.5, uv.y() - 0.5);
    normal_ += basis * basis.transpose();
    right_ += gray * basis;
  }
  void solve() { coefficients_ = normal_.ldlt().solve(right_); }
  double operator()(const Eigen::Vector2d& uv) const {
    return coefficients_.dot(Eigen::Vector3d(1.0, uv.x() - 0.5, uv.y() - 0.5));
  }

 private:
  Eigen::Matrix3d normal_ = 1e-3 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d coefficients_ = Eigen::Vector3d::Zero();
};

struct Sample {
  Eigen::Vector2d uv;
  double gray;
};

std::optional<double> sampleAt(const cv::Mat& gray, const TagMap& map, const Eigen::Vector2d& uv) {
  const Eigen::Vector2d px = map(uv);
  if (!canSample(gray, px.x(), px.y())) {
    return std::nullopt;
  }
  return sampleBilinear(gray, px.x(), px.y());
}

/// Samples along a square around the middle of the tag, `inset` inside its outline (outside where negative).
std::vector<Sample> sampleFrame(const cv::Mat& gray, const TagMap& map, double inset, int per_side) {
  std::vector<Sample> samples;
  for (int k = 0; k < per_side; ++k) {
    const double along = std::max(inset, 0.0) + (1.0 - 2.0 * std::max(inset, 0.0)) * (k + 0.5) / per_side;
    for (const Eigen::Vector2d& uv : {Eigen::Vector2d(along, inset), Eigen::Vector2d(along, 1.0 - inset),
                                      Eigen::Vector2d(inset, along), Eigen::Vector2d(1.0 - inset, along)}) {
      if (const auto value = sampleAt(gray, map, uv)) {
        samples.push_back({uv, *value});
      }
    }
  }
  return samples;
}

ShadePlane planeThrough(const std::vector<Sample>& samples) {
  ShadePlane plane;
  for (const Sample& sample : samples) {
    plane.add(sample.uv, sample.gray);
  }
  plane.solve();
  return plane;
}

/// Grey level half-way between ink and paper over a tag.
struct Threshold {
  ShadePlane dark;
  ShadePlane light;

  double operator()(const Eigen::Vector2d& uv) const { return 0.5 * (dark(uv) + light(uv)); }
};

/// Levels from the border and from the gap around the tag; nothing where one is not dark and the other not light.
std::optional<Threshold> findThreshold(const cv::Mat& gray, const TagMap& map, double border, double gap) {
  constexpr int kPerSide = 8;
  const auto inside = sampleFrame(gray, map, 0.5 * border, kPerSide);
  const auto outside = sampleFrame(gray, map, -0.5 * gap, kPerSide);
  if (inside.size() < 3 * kPerSide || outside.size() < kPerSide) {
    return std::nullopt;
  }
  const Threshold threshold = {planeThrough(inside), planeThrough(outside)};
  const Eigen::Vector2d middle(0.5, 0.5);
  if (threshold.light(middle) - threshold.dark(middle) < kMinContrast) {
    return std::nullopt;
  }
  const auto num_dark =
      std::count_if(inside.begin(), inside.end(), [&](const Sample& s) { return s.gray < threshold(s.uv); });
  const auto num_light =
      std::count_if(outside.begin(), outside.end(), [&](const Sample& s) { return s.gray > threshold(s.uv); });
  if (static_cast<double>(num_dark) < kMinDarkBorderShare * static_cast<double>(inside.size()) ||
      static_cast<double>(num_light) < kMinLightGapShare * static_cast<double>(outside.size())) {
    return std::nullopt;
  }
  return threshold;
}

/// Payload cells, -1 = as dark as the border, 1 = as light as the paper, with a frame of border cells around.
class CellGrid {
 public:
  explicit CellGrid(int payload_cells) : size_(payload_cells), stride_(payload_cells + 2) {
    values_.assign(static_cast<std::size_t>(stride_ * stride_), -1.0);
  }
  double& at(int row, int col) { return values_[index(row, col)]; }
  double at(int row, int col) const { return values_[index(row, col)]; }

  std::vector<double> payload() const {
    std::vector<double> cells;
    for (int i = 0; i < size_ * size_; ++i) {
      cells.push_back(at(i / size_, i % size_));
    }
    return cells;
  }

  std::uint64_t threshold(double sharpening) const {
    std::uint64_t code = 0;
    for (int row = 0; row < size_; ++row) {
      for (int col = 0; col < size_; ++col) {
        const double around = 0.25 * (at(row - 1, col) + at(row + 1, col) + at(row, col - 1) + at(row, col + 1));
        const bool white = at(row, col) + sharpening * (at(row, col) - around) > 0.0;
        code = (code << 1U) | (white ? 1U : 0U);
      }
    }
    return code;
  }

 private:
  std::size_t index(int row, int col) const { return static_cast<std::size_t>((row + 1) * stride_ + col + 1); }

  int size_;
  int stride_;
  std::vector<double> values_;
};

/// Mean of a few samples within the cell around `centre`; nothing outside of the image.
std::optional<double> sampleCell(const cv::Mat& gray, const TagMap& map, const Eigen::Vector2d& centre, double cell) {
  constexpr double kSpread = 0.22;  // [cells] from the centre
  double sum = 0.0;
  for (const Eigen::Vector2d& offset :
       {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(kSpread, kSpread), Eigen::Vector2d(-kSpread, kSpread),
        Eigen::Vector2d(kSpread, -kSpread), Eigen::Vector2d(-kSpread, -kSpread)}) {
    const auto value = sampleAt(gray, map, centre + cell * offset);
    if (!value) {
      return std::nullopt;
    }
    sum += *value;
  }
  return sum / 5.0;
}

int countBits(std::uint64_t bits) { return static_cast<int>(std::bitset<64>(bits).count()); }

struct NearestCode {
  std::size_t id = 0;
  int hamming = 64;
};

TARTAN_CALIB_POPCOUNT NearestCode nearestCode(const std::vector<std::uint64_t>& codes, std::uint64_t code) {
  NearestCode nearest;
  for (std::size_t id = 0; id < codes.size(); ++id) {
    const int hamming = __builtin_popcountll(code ^ codes[id]);
    if (hamming < nearest.hamming) {
      nearest = {id, hamming};
    }
  }
  return nearest;
}

}  // namespace

std::optional<TagReading> TagReader::read(const cv::Mat& gray, const TagMap& map, int border_cells, double gap) const {
  const int tag_cells = family_.payload_cells + 2 * border_cells;
  const double cell = 1.0 / tag_cells;
  const auto threshold = findThreshold(gray, map, border_cells * cell, gap);
  if (!threshold) {
    return std::nullopt;
  }
  CellGrid grid(family_.payload_cells);
  for (int row = 0; row < family_.payload_cells; ++row) {
    for (int col = 0; col < family_.payload_cells; ++col) {
      const Eigen::Vector2d centre = cell * Eigen::Vector2d(border_cells + col + 0.5, border_cells + row + 0.5);
      const auto value = sampleCell(gray, map, centre, cell);
      if (!value) {
        return std::nullopt;
      }
      const double half_contrast = std::max(0.5 * (threshold->light(centre) - threshold->dark(centre)), 1.0);
      grid.at(row, col) = (*value - (*threshold)(centre)) / half_contrast;
    }
  }
  TagReading reading;
  reading.cells = grid.payload();
  for (const double sharpening : kSharpenings) {
    const std::uint64_t code = grid.threshold(sharpening);
    if (reading.codes.empty() || code != reading.codes.back()) {
      reading.codes.push_back(code);
    }
  }
  return reading;
}

std::uint64_t TagReader::turned(std::uint64_t code) const {
  const int n = family_.payload_cells;
  std::uint64_t out = 0;
  for (int row = 0; row < n; ++row) {
    for (int col = 0; col < n; ++col) {
      const int cell = col * n + n - 1 - row;
      out = (out << 1U) | ((code >> static_cast<unsigned>(n * n - 1 - cell)) & 1U);
    }
  }
  return out;
}

std::uint64_t TagReader::mirrored(std::uint64_t code) const {
  const int n = family_.payload_cells;
  std::uint64_t out = 0;
  for (int row = 0; row < n; ++row) {
    for (int col = 0; col < n; ++col) {
      const int cell = col * n + row;
      out = (out << 1U) | ((code >> static_cast<unsigned>(n * n - 1 - cell)) & 1U);
    }
  }
  return out;
}

std::optional<TagMatch> TagReader::match(const TagReading& reading, int max_hamming) const {
  TagMatch best;
  best.hamming = max_hamming + 1;
  for (std::uint64_t code : reading.codes) {
    for (int top_left = 0; top_left < 4; ++top_left) {
      const NearestCode nearest = nearestCode(family_.codes, code);
      if (nearest.hamming < best.hamming) {
        best = {static_cast<int>(nearest.id), top_left, nearest.hamming};
      }
      code = turned(code);
    }
  }
  return best.tag_id < 0 ? std::nullopt : std::optional<TagMatch>(best);
}

std::optional<TagMatch> TagReader::matchMirrored(const TagReading& reading, int max_hamming) const {
  TagReading mirror;
  for (const std::uint64_t code : reading.codes) {
    mirror.codes.push_back(mirrored(code));
  }
  return match(mirror, max_hamming);
}

int TagReader::hammingTo(const TagReading& reading, int tag_id, int top_left) const {
  int best = family_.payload_cells * family_.payload_cells;
  for (std::uint64_t code : reading.codes) {
    for (int turn = 0; turn < top_left; ++turn) {
      code = turned(code);
    }
    best = std::min(best, countBits(code ^ family_.codes[static_cast<std::size_t>(tag_id)]));
  }
  return best;
}

}  // namespace tartan_calib::detection
