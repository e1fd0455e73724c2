// One triangle, to a file and back.

#include <mimetra/toolkit/vtk/vtp_series.h>
using namespace mimetra;

int main() {
  const Triangles triangle = Eigen::RowVector3i(0, 1, 2);
  Frames frames(1, 9);
  frames << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  const FieldSequence fields{MeshSequence(Connectivity::from_triangles(3, triangle), frames), {}};
  write_vtp_series(fields, "triangle.vtp", {.overwrite = true});
  return read_vtp_series("triangle.vtp").sequence().positions() == frames ? 0 : 1;
}
