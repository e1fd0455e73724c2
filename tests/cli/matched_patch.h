#pragma once

#include <string>

#include "tests/cli/bad_input.h"

/// The surface of the tests' model with a quarter of its faces.
namespace mimetra::test {

/// The patch of every other vertex, 8 x 8, as an OBJ file.
inline std::string small_patch() {
  RawMesh mesh;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      mesh.vertices.push_back({2.0 * x, 2.0 * y, 0.02 * (2 * x - 7) * (2 * x - 7)});
    }
  }
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 7; ++x) {
      const int a = 8 * y + x;
      mesh.faces.push_back({a, a + 1, a + 9, a + 8});
    }
  }
  return bytes_of(mesh, "obj");
}

/// Nine vertices of the model, 15 x 15, and of the small patch, counted from `base`.
inline std::string patch_markers(int base) {
  std::string text;
  for (const int y : {0, 3, 7}) {
    for (const int x : {0, 3, 7}) {
      text += std::to_string(30 * y + 2 * x + base) + ' ' + std::to_string(8 * y + x + base) + '\n';
    }
  }
  return text;
}

}  // namespace mimetra::test
