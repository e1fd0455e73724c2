// A grid twice as large moves as its source does, by the regions where that moves.

#include <cmath>

#include <mimetra/toolkit/pipeline/transfer.h>
using namespace mimetra;

int main() {
  constexpr int kSide = 6, kVertices = kSide * kSide, kFrames = 4;
  Positions rest(kVertices, 3);
  for (int v = 0; v < kVertices; ++v) rest.row(v) << v % kSide, v / kSide, 0.1 * v;
  Triangles triangles(2 * (kSide - 1) * (kSide - 1), 3);
  int t = 0;
  for (int v = 0; v + kSide < kVertices; ++v) {
    if (v % kSide == kSide - 1) continue;
    triangles.row(t++) << v, v + 1, v + kSide;
    triangles.row(t++) << v + 1, v + kSide + 1, v + kSide;
  }
  Frames frames(kFrames, 3 * kVertices);
  for (int f = 0; f < kFrames; ++f) {
    for (int v = 0; v < kVertices; ++v) frames.row(f).segment<3>(3 * v) = rest.row(v);
    frames(f, 3 * 14 + 2) += 0.2 * f;
  }
  const Connectivity faces = Connectivity::from_triangles(kVertices, triangles);
  const MeshSequence source(faces, frames, Eigen::VectorXd(), rest);
  const TriMesh large{2 * rest, faces};
  const TransferResult result = transfer(source, {{"large", large}}, {.analysis = {.count = 1}});
  const Frames pose = result.targets.front().solution.sequence->read(3, 1);
  const double lifted = pose(0, 3 * 14 + 2) - 2 * rest(14, 2);
  return result.regions->regions.size() == 1 && std::abs(lifted - 1.2) < 0.3 ? 0 : 1;
}
