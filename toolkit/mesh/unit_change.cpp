#include "toolkit/mesh/unit_change.h"

#include <utility>

namespace mimetra {
namespace {

using Coordinates = Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>;

/// Turns exactly: coordinates change places and signs.
void change_units(Coordinates positions, const UnitChange& change) {
  if (change.up != UpTurn::keep) {
    positions.col(1).swap(positions.col(2));
    const int turned = change.up == UpTurn::y_to_z ? 1 : 2;
    positions.col(turned) = 0 - positions.col(turned).array();  // 0 stays 0, and not -0
  }
  if (change.scale != 1) positions *= change.scale;
}

class FramesInUnits : public FrameSource {
 public:
  FramesInUnits(std::shared_ptr<const FrameSource> source, const UnitChange& change)
      : FrameSource(source->header()), source_(std::move(source)), change_(change) {
    change_units(header_.rest, change_);
  }

  bool is_quick() const override { return source_->is_quick(); }

 private:
  void read_frames(int first, FramesView poses) const override {
    source_->read(first, poses);
    change_units(Eigen::Map<Positions>(poses.data(), poses.size() / 3, 3), change_);
  }

  std::shared_ptr<const FrameSource> source_;
  UnitChange change_;
};

}  // namespace

std::shared_ptr<const FrameSource> with_units(std::shared_ptr<const FrameSource> source,
                                              const UnitChange& change) {
  check_options(change);
  if (change.scale == 1 && change.up == UpTurn::keep) return source;
  return std::make_shared<const FramesInUnits>(std::move(source), change);
}

}  // namespace mimetra
