#include "toolkit/io/frame_sequence.h"
#include "toolkit/io/material_library.h"
#include "toolkit/io/mesh_codecs.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/sequence_format.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/io/single_precision.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

OpenSequence open_mesh(const fs::path& path, const SequenceSource& source, const Context& context) {
  return open_frames({{path}}, {}, source, context);
}

class MeshSink : public FrameSink {
 public:
  MeshSink(const SequenceHeader& header, const fs::path& target,
           const SequenceWriteOptions& options, const ExtraFiles& extra)
      : header_(header),
        target_(target),
        extra_(extra),
        double_precision_(options.double_precision),
        fields_(options.fields),
        outputs_(options.overwrite, options.inputs, options.together),
        path_(outputs_.add(target, PendingOutput::Kind::file)) {
    if (lower_extension(target) != ".obj" || !header.connectivity->materials) return;
    const WrittenMaterials materials = materials_beside(*header.connectivity, target);
    header_.connectivity =
        std::make_shared<const Connectivity>(with_library(*header.connectivity, materials.name));
    if (materials.text) {
      library_ = target.parent_path() / materials.name;
      write_bytes(outputs_.add(library_, PendingOutput::Kind::file, PendingOutputs::Existing::same),
                  *materials.text);
    }
  }

  void write(int, const Frames& poses) override {
    const PositionsView pose(poses.data(), header_.connectivity->vertices, 3);
    const bool far_out = needs_double(pose, extent(header_.rest));
    write_mesh(path_, pose, *header_.connectivity,
               {.double_precision = double_precision_ || far_out,
                .extension = target_.extension().string(),
                .fields = fields_});
  }

  std::vector<fs::path> commit() override {
    std::vector<fs::path> files = {target_};
    if (!library_.empty()) files.push_back(library_);
    add_extra_beside(outputs_, target_, extra_, files);
    outputs_.commit();
    return files;
  }

 private:
  SequenceHeader header_;
  fs::path target_;
  ExtraFiles extra_;
  bool double_precision_;
  std::vector<Field> fields_;
  PendingOutputs outputs_;
  fs::path path_;
  /// Of its materials; empty where none is written.
  fs::path library_;
};

std::unique_ptr<FrameSink> begin_mesh(const SequenceHeader& header, const fs::path& target,
                                      const SequenceWriteOptions& options, const ExtraFiles& extra,
                                      const Context&) {
  if (header.times.size() != 1) {
    throw MismatchError(target.string() + ": one mesh file cannot hold " +
                        std::to_string(header.times.size()) +
                        " frames; name a folder, a .npy file, or one frame with option 'frames'");
  }
  return std::make_unique<MeshSink>(header, target, options, extra);
}

}  // namespace

SequenceFormat mesh_format(MeshFormat format) {
  const std::string name(choice_name(format));
  HeldParts holds = parts_held_by(format);
  holds.rest = false;
  holds.times = false;
  return {upper_case(name) + " mesh of one frame",
          {'.' + name},
          false,
          SequenceFormat::Precision::single_or_double,
          open_mesh,
          begin_mesh,
          holds,
          nullptr,
          mesh_codec('.' + name)->fields};
}

}  // namespace mimetra
