#include "tartan_calib/simulation/board_pattern.h"

#include <algorithm>
#include <string>

#include "tartan_calib/error.h"
#include "tartan_calib/target/tag_family.h"

namespace tartan_calib::simulation {
namespace {

/// One axis of an AprilGrid: margin, gap, then tags of `tag_cells` cells, each followed by a gap, and the margin.
class AprilGridAxis {
 public:
  AprilGridAxis(int num_tags, int tag_cells) : num_tags_(num_tags), tag_cells_(tag_cells) {}

  std::vector<double> lines(const target::AprilGrid& grid, double margin_m) const {
    const double gap_m = grid.tag_spacing_ratio * grid.tag_size_m;
    std::vector<double> lines_m = {-gap_m - margin_m, -gap_m};
    for (int tag = 0; tag < num_tags_; ++tag) {
      for (int cell = 0; cell <= tag_cells_; ++cell) {
        lines_m.push_back(tag * (grid.tag_size_m + gap_m) + cell * grid.tag_size_m / tag_cells_);
      }
    }
    lines_m.push_back(lines_m.back() + gap_m);
    lines_m.push_back(lines_m.back() + margin_m);
    return lines_m;
  }

  bool isMargin(int cell) const { return cell == 0 || cell == numCells() - 1; }
  bool isGap(int cell) const { return !isMargin(cell) && (cell - 1) % (tag_cells_ + 1) == 0; }
  int tagIndex(int cell) const { return (cell - 2) / (tag_cells_ + 1); }
  int cellInTag(int cell) const { return (cell - 2) % (tag_cells_ + 1); }
  int numCells() const { return num_tags_ * (tag_cells_ + 1) + 3; }

 private:
  int num_tags_;
  int tag_cells_;
};

class AprilGridInk {
 public:
  explicit AprilGridInk(const target::AprilGrid& grid)
      : grid_(grid),
        family_(target::tagFamily(grid.family)),
        cells_(family_.payload_cells + 2 * grid.border_cells),
        x_(grid.tag_cols, cells_),
        y_(grid.tag_rows, cells_) {
    if (grid.code_offset < 0 || static_cast<std::size_t>(grid.code_offset + target::numTags(grid)) > family_.codes.size()) {
      throw InputError("tag family " + grid.family + " has " + std::to_string(family_.codes.size()) +
                       " tags, too few for this board; choose fewer tags, a smaller codeOffset or another tagFamily");
    }
  }

  const AprilGridAxis& x() const { return x_; }
  const AprilGridAxis& y() const { return y_; }

  bool isBlack(int col, int row) const {
    if (x_.isMargin(col) || y_.isMargin(row)) {
      return false;
    }
    if (x_.isGap(col) || y_.isGap(row)) {
      return x_.isGap(col) && y_.isGap(row);
    }
    const int payload_col = x_.cellInTag(col) - grid_.border_cells;
    const int payload_row = family_.payload_cells - 1 - (y_.cellInTag(row) - grid_.border_cells);
    const auto in_payload = [this](int i) { return i >= 0 && i < family_.payload_cells; };
    if (!in_payload(payload_col) || !in_payload(payload_row)) {
      return true;
    }
    const int tag_id = grid_.code_offset + y_.tagIndex(row) * grid_.tag_cols + x_.tagIndex(col);
    return !target::isWhiteCell(family_, tag_id, payload_row, payload_col);
  }

 private:
  target::AprilGrid grid_;
  target::TagFamily family_;
  int cells_;
  AprilGridAxis x_;
  AprilGridAxis y_;
};

template <typename IsBlack>
void paint(BoardPattern& pattern, const IsBlack& is_black) {
  pattern.black.reserve(static_cast<std::size_t>(pattern.numRows()) * static_cast<std::size_t>(pattern.numCols()));
  for (int row = 0; row < pattern.numRows(); ++row) {
    for (int col = 0; col < pattern.numCols(); ++col) {
      pattern.black.push_back(is_black(col, row) ? 1 : 0);
    }
  }
}

std::vector<double> checkerboardLines(int inner_corners, double spacing_m, double margin_m) {
  std::vector<double> lines_m = {-spacing_m - margin_m};
  for (int corner = -1; corner <= inner_corners; ++corner) {
    lines_m.push_back(corner * spacing_m);
  }
  lines_m.push_back(inner_corners * spacing_m + margin_m);
  return lines_m;
}

struct PatternOf {
  double margin_m;

  BoardPattern operator()(const target::AprilGrid& grid) const {
    const AprilGridInk ink(grid);
    BoardPattern pattern;
    pattern.x_lines_m = ink.x().lines(grid, margin_m);
    pattern.y_lines_m = ink.y().lines(grid, margin_m);
    paint(pattern, [&ink](int col, int row) { return ink.isBlack(col, row); });
    return pattern;
  }

  BoardPattern operator()(const target::Checkerboard& board) const {
    BoardPattern pattern;
    pattern.x_lines_m = checkerboardLines(board.rows, board.row_spacing_m, margin_m);
    pattern.y_lines_m = checkerboardLines(board.cols, board.col_spacing_m, margin_m);
    paint(pattern, [&pattern](int col, int row) {
      const bool in_margin = col == 0 || row == 0 || col == pattern.numCols() - 1 || row == pattern.numRows() - 1;
      return !in_margin && (col + row) % 2 == 0;
    });
    return pattern;
  }

  BoardPattern operator()(const target::CircleGrid& /*grid*/) const {
    throw InputError("circle grids cannot be rendered; choose an aprilgrid or a checkerboard");
  }
};

struct HalfWindowOf {
  double operator()(const target::AprilGrid& grid) const {
    const int cells = target::tagFamily(grid.family).payload_cells + 2 * grid.border_cells;
    const double border_m = grid.border_cells * grid.tag_size_m / cells;
    return std::min(border_m, 0.5 * grid.tag_spacing_ratio * grid.tag_size_m);
  }
  double operator()(const target::Checkerboard& board) const {
    return 0.5 * std::min(board.row_spacing_m, board.col_spacing_m);
  }
  double operator()(const target::CircleGrid& grid) const { return 0.5 * grid.spacing_m; }
};

}  // namespace

BoardPattern boardPattern(const target::Target& target, double margin_m) { return std::visit(PatternOf{margin_m}, target); }

double cornerHalfWindow(const target::Target& target) { return std::visit(HalfWindowOf{}, target); }

}  // namespace tartan_calib::simulation
