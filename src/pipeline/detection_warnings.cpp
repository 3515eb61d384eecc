#include <algorithm>
#include <utility>

#include "tartan_calib/pipeline/warnings.h"
#include "tartan_calib/text.h"

namespace tartan_calib::pipeline {
namespace {

/// Tags that were seen and left out, all for one reason.
struct Dropped {
  int num_tags = 0;
  std::string note;
};

std::vector<Dropped> droppedTags(const detection::DetectionCounts& counts, const target::Target& target) {
  std::vector<Dropped> dropped;
  const auto add = [&dropped](int num_tags, const std::string& note) {
    if (num_tags > 0) {
      dropped.push_back({num_tags, note});
    }
  };
  add(counts.duplicate_tags,
      format("%d tags were dropped because their id was there twice in an image: is a second board in view?",
             counts.duplicate_tags));
  add(counts.foreign_tags,
      format("%d tags were dropped that the target does not have at that place: are tagRows, tagCols and codeOffset right?",
             counts.foreign_tags));
  add(counts.mirrored_tags,
      format("%d tags were dropped because they are mirrored: is the image flipped, or the board seen in a mirror?",
             counts.mirrored_tags));
  const auto* grid = std::get_if<target::AprilGrid>(&target);
  if (grid != nullptr && counts.other_border_tags > counts.tags) {
    add(counts.other_border_tags,
        format("the tags have a border of %d cells, the target says %d: set tagBorder: %d in the target file",
               3 - grid->border_cells, grid->border_cells, 3 - grid->border_cells));
  }
  return dropped;
}

/// Says so where clearly more images show a board of another size than one of the target's.
std::optional<std::string> otherSizeNote(const CameraCorners& corners, const target::Target& target) {
  std::size_t num_sized = 0;
  std::size_t num_images = 0;
  detection::BoardSize shown;
  for (const auto& [size, count] : corners.counts.other_sizes) {
    const auto num_with_size = static_cast<std::size_t>(count);
    num_sized += num_with_size;
    if (num_with_size > num_images) {
      num_images = num_with_size;
      shown = size;
    }
  }
  if (num_images <= corners.images.size() || 2 * num_images <= num_sized) {
    return std::nullopt;
  }
  const auto& [first, second] = shown;
  if (const auto* grid = std::get_if<target::AprilGrid>(&target)) {
    return format("%zu images show %d rows and %d columns of tags, the target says %d and %d: set tagRows and tagCols",
                  num_images, first, second, grid->tag_rows, grid->tag_cols);
  }
  if (const auto* board = std::get_if<target::Checkerboard>(&target)) {
    return format("%zu images show %dx%d inner corners, the target says %dx%d: set targetCols and targetRows", num_images,
                  first, second, std::min(board->cols, board->rows), std::max(board->cols, board->rows));
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> boardNote(const CameraCorners& corners, const target::Target& target) {
  if (std::optional<std::string> note = otherSizeNote(corners, target)) {
    return note;
  }
  const std::vector<Dropped> dropped = droppedTags(corners.counts, target);
  const auto fewer = [](const Dropped& a, const Dropped& b) { return a.num_tags < b.num_tags; };
  const auto most = std::max_element(dropped.begin(), dropped.end(), fewer);
  return most != dropped.end() && most->num_tags > corners.counts.tags ? std::make_optional(most->note) : std::nullopt;
}

std::vector<std::string> detectionWarnings(const CameraCorners& corners, int camera_index, const target::Target& target) {
  std::vector<std::string> warnings;
  const auto add = [&](const std::string& text) { warnings.push_back(cameraName(camera_index) + ": " + text); };
  if (corners.num_other_size > 0) {
    add(format("%zu images are not %dx%d as the others and were skipped", corners.num_other_size, corners.width,
               corners.height));
  }
  if (corners.num_unreadable > 0) {
    add(std::to_string(corners.num_unreadable) +
        " images cannot be read and were skipped; the first: " + corners.unreadable_reason);
  }
  if (corners.num_same_stamp > 0) {
    add(format("%zu images have the stamp of the image before and were skipped", corners.num_same_stamp));
  }
  if (const std::optional<std::string> note = otherSizeNote(corners, target); note && !corners.images.empty()) {
    add(*note);
  }
  for (const Dropped& dropped : droppedTags(corners.counts, target)) {
    add(dropped.note);
  }
  return warnings;
}

}  // namespace tartan_calib::pipeline
