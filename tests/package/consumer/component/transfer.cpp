// A strip of triangles twice as large moves as its source does.

#include <cmath>

#include <mimetra/toolkit/mesh/mesh_sequence.h>
#include <mimetra/toolkit/regions/regions.h>
#include <mimetra/toolkit/transfer/transfer_error.h>
#include <mimetra/toolkit/transfer/vertex_transfer.h>
using namespace mimetra;

int main() {
  constexpr int kVertices = 12, kFrames = 3;
  Positions rest(kVertices, 3);
  Triangles triangles(kVertices - 2, 3);
  for (int v = 0; v < kVertices; ++v) rest.row(v) << v / 2, v % 2, 0.1 * v * v;
  for (int t = 0; t < kVertices - 2; ++t) {
    triangles.row(t) << t, t + 1 + t % 2, t + 2 - t % 2;
  }
  Frames frames(kFrames, 3 * kVertices);
  for (int f = 0; f < kFrames; ++f) {
    for (int v = 0; v < kVertices; ++v) {
      frames.row(f).segment<3>(3 * v) = rest.row(v);
      frames(f, 3 * v + 1) += 0.3 * f * std::sin(v / 2);
    }
  }
  const MeshSequence source(Connectivity::from_triangles(kVertices, triangles), frames,
                            Eigen::VectorXd(), rest);
  const std::vector<int> all = all_triangles(triangles);
  const Frames moved = VertexTransfer(rest, 2 * rest, triangles, all).frames(source);
  const MeshSequence target = source.with_frames(moved).with_rest(2 * rest);
  return transfer_error(source, target, all).de_all < 1e-9 ? 0 : 1;
}
