// The only symbol of libmimetra_painter.

#include <string_view>

#include "toolkit/drawing/offscreen_window.h"
#include "toolkit/drawing/painter.h"

namespace mimetra {

namespace {

class VtkPainter final : public Painter {
 public:
  Image draw(const Sheet& sheet, const Context& context) const override {
    return drawn(sheet, context);
  }
  Image draw(const std::vector<Chart>& row, const ChartSize& size) const override {
    return drawn(row, size);
  }
  std::string png_of(const Image& image) const override { return encoded_png(image); }
  std::shared_ptr<void> one_window() const override { return std::make_shared<OneWindow>(); }
};

}  // namespace

}  // namespace mimetra

extern "C" __attribute__((visibility("default"))) const mimetra::Painter* mimetra_get_painter(
    const char* version) noexcept {
  static const mimetra::VtkPainter painter;
  return std::string_view(version) == MIMETRA_VERSION ? &painter : nullptr;
}
