#pragma once

#include <memory>
#include <string>

#include "toolkit/drawing/sheet.h"
#include "toolkit/mesh/context.h"

namespace mimetra {

/// Draws a sheet. Light comes from the upper left, so that wrinkles show; vertices at one place are
/// shaded as one. Throws std::invalid_argument for a sheet without tiles or larger than
/// kLargestPicture, std::runtime_error where there is no OpenGL or it has not enough memory,
/// Cancelled.
Image draw(const Sheet& sheet, const Context& context = {});

/// What this thread draws while it lives is drawn by one window: OpenGL starts, and compiles its
/// shaders, once instead of for each picture, and keeps its memory in between. The pictures are the
/// same bytes.
class DrawingSession {
 public:
  /// Throws std::runtime_error where the library that draws is missing.
  DrawingSession();
  DrawingSession(const DrawingSession&) = delete;
  DrawingSession& operator=(const DrawingSession&) = delete;

 private:
  std::shared_ptr<void> window_;
};

/// Bytes that draw() takes at its peak.
double drawing_bytes(const Sheet& sheet);

/// The picture as the bytes of a PNG file.
std::string png_of(const Image& image);

}  // namespace mimetra
