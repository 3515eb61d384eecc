#pragma once

#include <vector>

#include "tartan_calib/target/tag_family.h"

namespace tartan_calib::detection {

/// What the payloads of a board's tags look like when blur mixes their cells: for tags whose bits cannot be told apart any
/// more, but whose place on the board can.
class PayloadPatterns {
 public:
  /// The tag that cells look like most.
  struct Likeness {
    int tag_index = -1;
    int top_left = 0;
    double correlation = -1.0;
  };

  /// Tags first_id, first_id + 1, ... of the family, each under Gaussian blurs [cells], by default of all strengths at which
  /// tags of a board can be told apart.
  PayloadPatterns(const target::TagFamily& family, int first_id, int num_tags,
                  const std::vector<double>& blur_sigmas_cells = {0.4, 0.7, 1.1});

  /// False for cells that are all about alike, such as those of the small squares between tags.
  static bool isPayload(const std::vector<double>& cells);

  /// Correlation, -1 to 1, of cells as sampled (row by row) with a tag whose printed top left corner is at corner
  /// `top_left`, for the kind of blur that fits best. 0 where the cells are all alike.
  double correlation(const std::vector<double>& cells, int tag_index, int top_left) const;

  /// The best of all tags in all four turns.
  Likeness mostAlike(const std::vector<double>& cells) const;

 private:
  std::vector<double> turned(std::vector<double> cells, int top_left) const;
  double bestOverBlurs(const std::vector<double>& normalized_cells, int tag_index) const;

  int payload_cells_;
  std::vector<std::vector<std::vector<double>>> patterns_;  ///< [tag][blur]: cells with mean 0 and length 1
};

}  // namespace tartan_calib::detection
