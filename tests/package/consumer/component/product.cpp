// A product has the same bytes, whatever caches the program sets in Eigen.

#include <cstring>

#include <mimetra/toolkit/model/blendshape_model.h>

int main() {
  constexpr int kVertices = 30, kExpressions = 1200, kFrames = 20;
  mimetra::ShapeBasis expressions{{}, Eigen::MatrixXd::Random(3 * kVertices, kExpressions)};
  for (int j = 0; j < kExpressions; ++j) expressions.names.push_back(std::to_string(j));
  const mimetra::Triangles triangle = Eigen::RowVector3i(0, 1, 2);
  const mimetra::BlendshapeModel model(
      std::make_shared<mimetra::Connectivity>(
          mimetra::Connectivity::from_triangles(kVertices, triangle)),
      mimetra::Positions::Random(kVertices, 3), std::move(expressions));
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Random(kFrames, kExpressions);
  const mimetra::Frames expected = model.animate(weights).positions();
  for (const int kilobytes : {16, 48, 128}) {
    Eigen::setCpuCacheSizes(1024 * kilobytes, 16 * 1024 * kilobytes, 64 * 1024 * kilobytes);
    const mimetra::Frames frames = model.animate(weights).positions();
    const std::size_t bytes = sizeof(double) * static_cast<std::size_t>(frames.size());
    if (std::memcmp(frames.data(), expected.data(), bytes) != 0) return 1;
  }
  return 0;
}
