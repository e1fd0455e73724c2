#include <gmock/gmock.h>

#include "tests/streams.h"
#include "tests/transfer/faces.h"
#include "toolkit/mesh/frame_store.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/transfer_error.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra {
namespace {

using testing::ThrowsMessage;

/// A performance in memory and as a stream; 43 frames are three blocks of sixteen, the last not
/// full.
class StreamedPerformance : public testing::Test {
 protected:
  const MeshSequence performance_ = test::shaken(test::patch(), 43, 0.2);
  const test::Stream stream_{performance_};
  const test::Stream broken_{performance_, 37};
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), 5);
  const std::vector<int> selected_ = test::half_of(actor_.triangles());

  VertexTransfer to_vertices(const Context& context = {}) const {
    return VertexTransfer(performance_.rest(), actor_.neutral(), actor_.triangles(), selected_, {},
                          context);
  }
};

TEST_F(StreamedPerformance, HasTheSameWeights) {
  for (const double smoothness : {0.0, 0.1}) {
    for (const int threads : {1, 3}) {
      const Context context = Context().with_threads(threads);
      const BlendshapeTransfer transfer(performance_.rest(), actor_, selected_,
                                        {.smoothness = smoothness}, context);
      const Eigen::MatrixXd weights = transfer.weights(performance_, context);
      EXPECT_TRUE(transfer.weights(stream_, context) == weights);
      EXPECT_EQ(transfer.rest_looks_unneutral(stream_, weights, context),
                transfer.rest_looks_unneutral(performance_, weights, context));
    }
  }
}

TEST_F(StreamedPerformance, MovesTheSameVertices) {
  const Frames expected = to_vertices().frames(performance_);
  EXPECT_TRUE(to_vertices().frames(stream_) == expected);
  for (const int threads : {1, 3}) {
    FrameStore store({actor_.shared_connectivity(), performance_.times(), actor_.neutral(), true},
                     0);
    const Context context = Context().with_threads(threads);
    to_vertices(context).write_frames(stream_, store, context);
    EXPECT_TRUE(store.read(0, 43) == expected);
  }
}

TEST_F(StreamedPerformance, IsMeasuredTheSame) {
  const MeshSequence result(actor_.shared_connectivity(), to_vertices().frames(performance_), {},
                            actor_.neutral());
  const TransferError expected = transfer_error(performance_, result, selected_);
  for (const int threads : {1, 3}) {
    const TransferError found = transfer_error(stream_, test::Stream(result), selected_, {},
                                               Context().with_threads(threads));
    EXPECT_TRUE(found.per_frame == expected.per_frame);
    EXPECT_TRUE(found.per_triangle == expected.per_triangle);
    EXPECT_EQ(found.de_all, expected.de_all);
    EXPECT_EQ(found.de_region, expected.de_region);
    EXPECT_EQ(found.leak, expected.leak);
    EXPECT_EQ(found.flipped, expected.flipped);
  }
}

TEST_F(StreamedPerformance, ThatBreaksThrowsWhatReadingThrows) {
  const auto breaks = ThrowsMessage<std::runtime_error>("frame 37 is broken");
  const BlendshapeTransfer transfer(performance_.rest(), actor_, selected_);
  EXPECT_THAT([&] { transfer.weights(broken_); }, breaks);
  EXPECT_THAT([&] { to_vertices().frames(broken_); }, breaks);
  EXPECT_THAT([&] { transfer_error(broken_, performance_, selected_); }, breaks);
  EXPECT_THAT([&] { transfer_error(performance_, broken_, selected_); }, breaks);
}

TEST_F(StreamedPerformance, IsNotMeasuredFurtherThanProgressAllows) {
  const Context unfinished = Context().with_progress([](double share) { return share < 1; });
  EXPECT_THROW(transfer_error(stream_, stream_, selected_, {}, unfinished), Cancelled);
}

}  // namespace
}  // namespace mimetra
