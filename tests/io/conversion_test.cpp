#include <cstdio>

#include <gmock/gmock.h>

#include "tests/shapes.h"
#include "tests/shared_data.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/formats.h"
#include "toolkit/formats/sequence_file.h"

namespace mimetra {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

/// Names of outputs, one for each extension of a format that keeps its vertices.
std::vector<std::string> outputs() {
  std::vector<std::string> names;
  for (const Format& format : formats()) {
    if (!format.open || !format.create || format.has(Format::kFolder)) continue;
    if (!format.holds({}).vertex_order) continue;
    for (const std::string& extension : format.extensions) {
      names.push_back(format.mesh_frame ? extension.substr(1) + '/' : "a" + extension);
    }
  }
  return names;
}

/// Largest differences of what came back: positions as a share of the longest side, seconds.
struct Difference {
  double positions;
  double seconds;
  bool faces;
};

class Conversions : public testing::Test {
 protected:
  static WriteOptions options_of(const std::string& output) {
    WriteOptions options;
    if (output.ends_with('/')) options.frame_format = output.substr(0, output.size() - 1);
    return options;
  }

  MeshSequence by(const FrameSource& sequence, const std::string& output, const std::string& step) {
    const fs::path target = folder_ / step / output;
    write_sequence(sequence, target, options_of(output));
    return read_sequence(target.string()).sequence;
  }

  static Difference difference(const MeshSequence& found, const MeshSequence& expected) {
    const bool same_triangles = found.triangles() == expected.triangles();
    return {
        (found.positions() - expected.positions()).cwiseAbs().maxCoeff() / extent(expected.rest()),
        (found.times() - expected.times()).cwiseAbs().maxCoeff(),
        same_triangles || same_faces(found.connectivity(), expected.connectivity())};
  }

  /// Every format into every other, and what has become of the sequence; printed as a table.
  void expect_all_kept(const std::string& name, const MeshSequence& sequence,
                       const std::vector<std::string>& targets) {
    std::printf("%s: largest difference of positions, share of the longest side\n%8s", name.c_str(),
                "from/to");
    for (const std::string& to : targets) std::printf(" %7s", to.c_str());
    std::printf("\n");
    for (const std::string& from : targets) {
      const std::string step = "from" + std::to_string(&from - targets.data());
      const MeshSequence first = by(sequence, from, step);
      std::printf("%8s", from.c_str());
      for (const std::string& to : targets) {
        const Difference kept =
            difference(by(first, to, step + "to" + std::to_string(&to - targets.data())), sequence);
        std::printf(" %7.1e", kept.positions);
        // Each of the two may round to float32; poses of glTF are sums of two such numbers.
        EXPECT_LT(kept.positions, 4 * 6e-8) << from << " to " << to;
        EXPECT_LT(kept.seconds, 2 * 6e-8 * sequence.times().maxCoeff()) << from << " to " << to;
        EXPECT_TRUE(kept.faces) << from << " to " << to;
      }
      std::printf("\n");
    }
  }

  TemporaryFolder folder_;
};

TEST_F(Conversions, KeepPositionsTimesAndFacesBetweenAnyTwoFormats) {
  TriMesh mesh = test::mesh_of(test::grid(4, 3));
  Frames poses(5, mesh.positions.size());
  for (int f = 0; f < poses.rows(); ++f) {
    const Positions pose = mesh.positions.array() + (0.7 * f + mesh.positions.array()).sin();
    poses.row(f) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  }
  Eigen::VectorXd times(5);
  times << 0.25, 0.3, 0.5, 1.5, 1.75;
  expect_all_kept("made", {mesh.connectivity, poses, times, mesh.positions}, outputs());
}

TEST_F(Conversions, KeepARealPerformance) {
  const fs::path file = test::shared_path("data/facecap/facecap.glb");
  MIMETRA_SKIP_WITHOUT(file);
  const SequenceRead read = read_sequence(file.string(), {.frames = "0:20"});
  // One format of each kind of numbers.
  expect_all_kept("facecap.glb, 20 frames", read.sequence,
                  {"ply/", "obj/", "a.npy", "a.pc2", "a.glb"});
}

}  // namespace
}  // namespace mimetra
