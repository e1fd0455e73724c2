#pragma once

#include <vector>

#include "toolkit/operations/image.h"

/// The pyramid of ever smaller images in which dlib's detector looks for faces of one size.
/// Internal to faces_by_dlib.cpp.
namespace mimetra {

/// Columns or rows, from `first` to before `last`.
struct PixelRange {
  int first = 0;
  int last = 0;

  int size() const { return last - first; }
  bool operator==(const PixelRange&) const = default;
};

/// A rectangle of pixels.
struct PixelArea {
  PixelRange columns;
  PixelRange rows;
  bool operator==(const PixelArea&) const = default;
};

/// The least area that holds both; an empty one holds nothing.
PixelArea joined(const PixelArea& a, const PixelArea& b);

/// A part of a level.
struct PyramidPart {
  PixelArea area;
  Image pixels;
};

/// An image's pyramid, of which only parts are made, with the pixels that the whole of it has
/// there.
///
/// Each level has five sixths of the columns and rows of the one before, between whose pixels it
/// interpolates; the corners' pixels coincide.
class DetectorPyramid {
 public:
  /// Levels down to `least` columns and rows; 0 is the image itself, which must outlive this.
  DetectorPyramid(const Image& image, int least);

  int levels() const { return static_cast<int>(whole_.size()); }
  /// All of a level.
  const PixelArea& whole(int level) const { return whole_.at(static_cast<std::size_t>(level)); }

  /// The pixels of `wanted`, one area for each of the first levels; empty for levels that nothing
  /// is wanted of. \pre areas are inside their levels
  std::vector<PyramidPart> parts(const std::vector<PixelArea>& wanted) const;

 private:
  /// What a level's area is interpolated between, in the level before.
  PixelArea source_of(int level, const PixelArea& area) const;
  Image interpolated(const PyramidPart& before, int level, const PixelArea& area) const;

  const Image& image_;
  std::vector<PixelArea> whole_;
};

}  // namespace mimetra
