#include "toolkit/mesh/fields.h"

#include <stdexcept>

namespace mimetra {

FieldSequence::FieldSequence(std::shared_ptr<const FrameSource> source, std::vector<Field> shown,
                             bool with_displacement)
    : frames(std::move(source)), fields(std::move(shown)), displacement(with_displacement) {}

FieldSequence::FieldSequence(MeshSequence sequence, std::vector<Field> shown,
                             bool with_displacement)
    : FieldSequence(std::make_shared<const MeshSequence>(std::move(sequence)), std::move(shown),
                    with_displacement) {}

const MeshSequence& FieldSequence::sequence() const {
  if (const auto* held = dynamic_cast<const MeshSequence*>(frames.get())) return *held;
  throw std::logic_error("the frames of the sequence are not in memory");
}

bool FieldSequence::is_in_memory() const {
  return dynamic_cast<const MeshSequence*>(frames.get()) != nullptr;
}

FieldSequence held_like(const FieldSequence& like, std::shared_ptr<const FrameSource> frames,
                        const BlockOptions& options) {
  FieldSequence made(std::move(frames));
  if (!like.is_in_memory() || made.is_in_memory()) return made;
  return MeshSequence(*made.frames, options);
}

}  // namespace mimetra
