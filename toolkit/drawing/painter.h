#pragma once

#include <memory>
#include <string>
#include <vector>

#include "toolkit/drawing/chart.h"
#include "toolkit/drawing/picture.h"

namespace mimetra {

/// Interface of libmimetra_painter, the only library that needs VTK's renderers. Loading them takes
/// longer than a whole command that draws nothing.
class Painter {
 public:
  virtual ~Painter() = default;
  virtual Image draw(const Sheet& sheet, const Context& context) const = 0;
  virtual Image draw(const std::vector<Chart>& row, const ChartSize& size) const = 0;
  virtual std::string png_of(const Image& image) const = 0;
  /// State of a DrawingSession.
  virtual std::shared_ptr<void> one_window() const = 0;
};

/// Painter of the library, which is loaded on the first call. Throws std::runtime_error if it is
/// missing or has another version.
const Painter& painter();

/// Implementations in the library, with VTK's renderers.
Image drawn(const Sheet& sheet, const Context& context);
Image drawn(const std::vector<Chart>& row, const ChartSize& size);
std::string encoded_png(const Image& image);

}  // namespace mimetra

/// Returns the library's painter, or null for another version.
extern "C" using GetMimetraPainter = const mimetra::Painter * (*)(const char* version);
