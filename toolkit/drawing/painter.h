#pragma once

#include <memory>
#include <string>
#include <vector>

#include "toolkit/drawing/chart.h"
#include "toolkit/drawing/picture.h"

namespace mimetra {

/// What draws: libmimetra_painter, which alone needs VTK's renderers. They take longer to load than
/// a command that draws nothing takes from beginning to end.
class Painter {
 public:
  virtual ~Painter() = default;
  virtual Image draw(const Sheet& sheet, const Context& context) const = 0;
  virtual Image draw(const std::vector<Chart>& row, const ChartSize& size) const = 0;
  virtual std::string png_of(const Image& image) const = 0;
  /// What a DrawingSession holds.
  virtual std::shared_ptr<void> one_window() const = 0;
};

/// Loads the library when it is first asked for. Throws std::runtime_error where it is missing or
/// of another version.
const Painter& painter();

/// In the library: what its Painter does, with VTK's renderers.
Image drawn(const Sheet& sheet, const Context& context);
Image drawn(const std::vector<Chart>& row, const ChartSize& size);
std::string encoded_png(const Image& image);

}  // namespace mimetra

/// What the library shows; null where it is of another version.
extern "C" using GetMimetraPainter = const mimetra::Painter * (*)(const char* version);
