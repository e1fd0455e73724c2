// Along the edge of a unit square of two triangles.

#include <cmath>

#include <mimetra/geodesic/exact_geodesics.h>

int main() {
  mimetra::Positions positions(4, 3);
  positions << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  mimetra::Triangles triangles(2, 3);
  triangles << 0, 1, 2, 0, 2, 3;
  const mimetra::geodesic::ExactGeodesics geodesics(positions, triangles);
  return std::abs(geodesics.distances(0)[1] - 1) < 1e-12 ? 0 : 1;
}
