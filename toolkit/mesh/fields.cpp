#include "toolkit/mesh/fields.h"

#include <limits>
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

bool is_displacement(const Field& field) {
  return field.location == Field::Location::vertices &&
         (field.name == kDisplacement || field.name == kDisplacementLength);
}

bool has_left_its_rest(const FrameSource& frames) {
  if (!frames.rest_is_known()) return false;
  return frames.frames() > 1 || FrameBlock(frames, 0, 1).frame(0) != frames.rest();
}

void show_displacement(FieldSequence& sequence) {
  if (!has_left_its_rest(*sequence.frames)) return;
  sequence.displacement = true;
  std::erase_if(sequence.fields, is_displacement);
}

Eigen::MatrixXd on_polygons(const Eigen::MatrixXd& on_triangles, const Connectivity& connectivity) {
  Eigen::MatrixXd values = Eigen::MatrixXd::Constant(
      connectivity.polygons.size(), on_triangles.cols(), -std::numeric_limits<double>::infinity());
  for (Eigen::Index t = 0; t < on_triangles.rows(); ++t) {
    const int polygon = connectivity.polygon_of_triangle[static_cast<std::size_t>(t)];
    values.row(polygon) = values.row(polygon).cwiseMax(on_triangles.row(t));
  }
  return values;
}

FieldSequence held_like(const FieldSequence& like, std::shared_ptr<const FrameSource> frames,
                        const Context& context) {
  FieldSequence made(std::move(frames));
  if (!like.is_in_memory() || made.is_in_memory()) return made;
  return MeshSequence(*made.frames, context);
}

}  // namespace mimetra
