#include "create_target/sheet.h"

#include <algorithm>
#include <optional>
#include <regex>
#include <vector>

#include "common/program.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

/// What printers leave blank is 3 to 6 mm; a board needs white around it as well.
constexpr double kMargin_mm = 10.0;
/// For the ruler and two lines of text.
constexpr double kFooter_mm = 17.0;
/// Slack for sizes that only rounding keeps from fitting.
constexpr double kTolerance_mm = 1e-6;

struct Paper {
  std::string name;
  Eigen::Vector2d size_mm;
};

const std::vector<Paper>& knownPapers() {
  static const std::vector<Paper> papers = {{"A4", {210, 297}}, {"A3", {297, 420}},  {"A2", {420, 594}},
                                            {"A1", {594, 841}}, {"A0", {841, 1189}}, {"letter", {215.9, 279.4}}};
  return papers;
}

constexpr std::size_t kNumIsoPapers = 5;  ///< the first of them

std::string sizeText(const Eigen::Vector2d& size_mm) { return format("%.1f x %.1f mm", size_mm.x(), size_mm.y()); }

/// A board and what goes with it, without more paper than it must have.
Eigen::Vector2d neededSize(const Artwork& artwork) {
  return {std::max(artwork.size_mm.x(), kRulerLength_mm) + 2.0 * kMargin_mm,
          artwork.size_mm.y() + 2.0 * kMargin_mm + kFooter_mm};
}

/// The paper as it is or turned; empty where neither way is large enough.
std::optional<Eigen::Vector2d> turnedToFit(const Eigen::Vector2d& paper_mm, const Eigen::Vector2d& needed_mm) {
  for (const Eigen::Vector2d& size_mm : {paper_mm, Eigen::Vector2d(paper_mm.y(), paper_mm.x())}) {
    if (((size_mm - needed_mm).array() > -kTolerance_mm).all()) {
      return size_mm;
    }
  }
  return std::nullopt;
}

Paper paperOf(const std::string& name) {
  for (const Paper& paper : knownPapers()) {
    if (paper.name == name) {
      return paper;
    }
  }
  std::smatch numbers;
  if (!std::regex_match(name, numbers, std::regex(R"((\d{1,5}(?:\.\d{1,4})?)x(\d{1,5}(?:\.\d{1,4})?))"))) {
    throw UsageError("--page " + name + " is no paper: choose A4, A3, A2, A1, A0, letter or, in millimetres, WIDTHxHEIGHT");
  }
  return {"paper", {std::stod(numbers[1]), std::stod(numbers[2])}};
}

Paper smallestPaper(const Eigen::Vector2d& needed_mm) {
  for (std::size_t i = 0; i < kNumIsoPapers; ++i) {
    if (turnedToFit(knownPapers()[i].size_mm, needed_mm)) {
      return knownPapers()[i];
    }
  }
  return {"paper", needed_mm};
}

}  // namespace

Sheet layOut(const Artwork& artwork, const std::string& paper) {
  const Eigen::Vector2d needed_mm = neededSize(artwork);
  const Paper chosen = paper.empty() ? smallestPaper(needed_mm) : paperOf(paper);
  const std::optional<Eigen::Vector2d> size_mm = turnedToFit(chosen.size_mm, needed_mm);
  if (!size_mm) {
    throw InputError("the board of " + sizeText(artwork.size_mm) + " needs, with margins and ruler, " + sizeText(needed_mm) +
                     " of paper, but " + chosen.name + " has " + sizeText(chosen.size_mm) +
                     ": choose a larger --page, or a smaller board");
  }
  Sheet sheet;
  sheet.paper = chosen.name + ", " + sizeText(*size_mm);
  sheet.size_mm = *size_mm;
  sheet.artwork = artwork;
  const Eigen::Vector2d free_mm = *size_mm - artwork.size_mm - Eigen::Vector2d(0.0, kFooter_mm);
  sheet.artwork_mm = 0.5 * free_mm;
  sheet.ruler_mm = {kMargin_mm, size_mm->y() - kMargin_mm - kFooter_mm + 7.0};
  return sheet;
}

}  // namespace tartan_calib::apps
