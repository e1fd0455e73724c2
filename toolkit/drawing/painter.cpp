#include "toolkit/drawing/painter.h"

#include <filesystem>
#include <stdexcept>
#include <system_error>

#include <dlfcn.h>

#include "toolkit/drawing/sheet_layout.h"
#include "toolkit/operations/this_process.h"

namespace mimetra {

namespace {

constexpr const char* kLibrary = "libmimetra_painter.so.1";

/// Path of the library beside the binary of this code, or relative to a program's folder. Otherwise
/// its bare name, for the loader to search.
std::filesystem::path place_of_library() {
  const std::filesystem::path folder = this_binary().parent_path();
  for (const char* way : {".", "../lib", "../" MIMETRA_LIBRARY_FOLDER}) {
    std::error_code error;
    const std::filesystem::path place = folder / way / kLibrary;
    if (std::filesystem::exists(place, error)) return place;
  }
  return kLibrary;
}

const Painter& loaded() {
  const std::filesystem::path place = place_of_library();
  // Never unload it: VTK registers functions that run at the end of the process.
  void* library = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) throw std::runtime_error(std::string("pictures cannot be drawn: ") + dlerror());
  void* symbol = dlsym(library, "mimetra_get_painter");
  const Painter* painter =
      symbol ? reinterpret_cast<GetMimetraPainter>(symbol)(MIMETRA_VERSION) : nullptr;
  if (!painter) {
    throw std::runtime_error(place.string() + " is not of version " MIMETRA_VERSION
                                              ": install it again");
  }
  return *painter;
}

}  // namespace

const Painter& painter() {
  static const Painter& painter = loaded();
  return painter;
}

Image draw(const Sheet& sheet, const Context& context) {
  return painter().draw(sheet, context);
}

Image draw(const std::vector<Chart>& row, const ChartSize& size) {
  return painter().draw(row, size);
}

std::string png_of(const Image& image) {
  return painter().png_of(image);
}

DrawingSession::DrawingSession() : window_(painter().one_window()) {}

double drawing_bytes(const Sheet& sheet) {
  // Colour and depth of four samples per pixel, one resolved and one read copy, the PNG, and
  // overhead. Measured.
  constexpr double kBytesPerPixel = 86;
  // OpenGL without a graphics card, including compiled shaders. Measured for pictures of any size.
  constexpr double kOpenGl = 135e6;
  // Positions, normals, colours and corners, here and in OpenGL. Measured with 5000 and 325 000
  // vertices in 1 to 9 tiles.
  constexpr double kBytesPerVertex = 240;
  const SheetLayout layout = SheetLayout::of(sheet);
  double vertices = 0;
  for (const TileRow& row : sheet.rows) {
    for (const Tile& tile : row.tiles) vertices += static_cast<double>(tile.positions.rows());
  }
  const double of_vertex = kBytesPerVertex * (sheet.edges ? 2 : 1);
  return kOpenGl + kBytesPerPixel * layout.width * layout.height + of_vertex * vertices;
}

}  // namespace mimetra
