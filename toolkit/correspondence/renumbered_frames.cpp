#include "toolkit/correspondence/renumbered_frames.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace mimetra {
namespace {

class RenumberedFrames : public FrameSource {
 public:
  RenumberedFrames(std::shared_ptr<const FrameSource> source,
                   std::shared_ptr<const Connectivity> connectivity,
                   std::vector<VertexIndex> vertices)
      : FrameSource(source->header()), source_(std::move(source)), vertices_(std::move(vertices)) {
    header_.connectivity = std::move(connectivity);
    header_.rest = Positions(header_.rest(vertices_, Eigen::all));
  }

  bool is_quick() const override { return source_->is_quick(); }

 private:
  void read_frames(int first, FramesView poses) const override {
    const FrameBlock block(*source_, first, static_cast<int>(poses.rows()));
    for (int row = 0; row < block.frames(); ++row) {
      Eigen::Map<Positions>(poses.row(row).data(), poses.cols() / 3, 3) =
          block.frame(row)(vertices_, Eigen::all);
    }
  }

  std::shared_ptr<const FrameSource> source_;
  std::vector<VertexIndex> vertices_;
};

}  // namespace

std::shared_ptr<const FrameSource> renumbered(std::shared_ptr<const FrameSource> source,
                                              std::shared_ptr<const Connectivity> connectivity,
                                              std::vector<VertexIndex> vertices) {
  const bool are_there = std::ranges::all_of(
      vertices, [&source](VertexIndex v) { return v >= 0 && v < source->vertices(); });
  if (static_cast<int>(vertices.size()) != connectivity->vertices || !are_there) {
    throw std::invalid_argument("expected a vertex of the source for each of " +
                                std::to_string(connectivity->vertices) + " vertices");
  }
  return std::make_shared<const RenumberedFrames>(std::move(source), std::move(connectivity),
                                                  std::move(vertices));
}

Field renumbered(const Field& field, const std::vector<VertexIndex>& vertices) {
  Field result = field;
  result.values = field.values(vertices, Eigen::all);
  return result;
}

}  // namespace mimetra
