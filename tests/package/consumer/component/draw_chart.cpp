#include <iostream>

#include <mimetra/toolkit/drawing/chart.h>
#include <mimetra/toolkit/drawing/picture.h>

int main() {
  const mimetra::Chart chart{"squares", {"x"}, {"y"}, {{"x * x", {1, 2, 3}, {1, 4, 9}}}};
  const std::string png = mimetra::png_of(mimetra::draw({chart}));
  if (png.starts_with("\x89PNG")) return 0;
  std::cerr << "no PNG file: " << png.size() << " bytes\n";
  return 1;
}
