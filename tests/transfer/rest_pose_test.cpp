#include <gtest/gtest.h>

#include "tests/transfer/captured_faces.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/blendshape_transfer.h"

/// Whether a source's rest pose is neutral, on a real capture of two real identities.
namespace mimetra {
namespace {

struct Faces {
  MeshSequence take;
  BlendshapeModel target;
};

/// Two seconds, ten of its frames.
Faces captured_faces() {
  const std::vector<std::string> names = test::ict_expressions();
  return {test::ict_face("identity003", 1.5, names).animate(test::captured_weights(names, 120, 12)),
          test::ict_face("identity007", 2, names)};
}

bool looks_unneutral(const MeshSequence& take, const BlendshapeModel& target) {
  const BlendshapeTransfer transfer(take.rest(), target, all_triangles(target.triangles()));
  return transfer.rest_looks_unneutral(take, transfer.weights(take));
}

TEST(RestPose, OfACaptureLooksNeutralOnlyWhereItIs) {
  MIMETRA_SKIP_WITHOUT(test::shared_path("data/ict-face"));
  const Faces faces = captured_faces();
  EXPECT_FALSE(looks_unneutral(faces.take, faces.target));
  EXPECT_TRUE(looks_unneutral(faces.take.with_rest(faces.take.frame(0)), faces.target));
}

}  // namespace
}  // namespace mimetra
