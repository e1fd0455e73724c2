#include "toolkit/mesh/unit_change.h"

#include <utility>

namespace mimetra {
namespace {

class FramesInUnits : public FrameSource {
 public:
  FramesInUnits(std::shared_ptr<const FrameSource> source, const UnitChange& change)
      : FrameSource(in_units(source->header(), change)),
        source_(std::move(source)),
        change_(change) {}

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

void change_units(CoordinatesView positions, const UnitChange& change) {
  if (change.up != UpTurn::keep) {
    positions.col(1).swap(positions.col(2));
    const int turned = change.up == UpTurn::y_to_z ? 1 : 2;
    positions.col(turned) = 0 - positions.col(turned).array();  // keeps 0 instead of -0
  }
  if (change.scale != 1) positions *= change.scale;
}

SequenceHeader in_units(SequenceHeader header, const UnitChange& change) {
  change_units(header.rest, change);
  return header;
}

std::shared_ptr<const FrameSource> with_units(std::shared_ptr<const FrameSource> source,
                                              const UnitChange& change) {
  check_options(change);
  if (change.scale == 1 && change.up == UpTurn::keep) return source;
  return std::make_shared<const FramesInUnits>(std::move(source), change);
}

}  // namespace mimetra
