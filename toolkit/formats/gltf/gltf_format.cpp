#include "toolkit/formats/gltf/gltf_format.h"

#include <algorithm>
#include <iterator>

#include "toolkit/formats/gltf/gltf_write.h"
#include "toolkit/formats/gltf/scene.h"
#include "toolkit/io/file_parameters.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/frame_times.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/model/animation.h"
#include "toolkit/model/expression_notes.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// The model is driven by the weights of the options, else by the file's own; without either it is
/// the neutral.
OpenSequence open_scene(const fs::path& path, const ReadOptions& options, const Context& context) {
  Scene scene = read_gltf(path, context);
  const auto frames = static_cast<int>(scene.weights.rows());
  OpenSequence open;
  if (options.weights || frames == 0) {
    open = drive(scene.model, path, options);
  } else {
    const std::vector<int> chosen = selected_frames(options.frames, frames);
    std::optional<Eigen::VectorXd> of_scene;
    if (scene.times.size() > 0) of_scene = scene.times;
    const FrameTimes times = frame_times(path.string(), frames, std::move(of_scene), options.fps);
    open.model_driven = true;
    open.frames = std::make_shared<const Animation>(
        scene.performer, Eigen::MatrixXd(scene.weights(chosen, Eigen::all)), times.seconds(chosen),
        times.are_known);
  }
  if (!scene.rest_is_known && !options.weights) {
    open.frames = with_rest(open.frames, std::nullopt);
    open.model_driven = false;
  }
  open.files = scene.files;
  if (options.weights) open.files.push_back(*options.weights);
  std::vector<std::string>& notes = scene.notes;
  const auto& of_use = options.weights ? scene.model_notes : scene.motion_notes;
  notes.insert(notes.end(), of_use.begin(), of_use.end());
  open.notes.insert(open.notes.begin(), notes.begin(), notes.end());
  return open;
}

ReadValue read_model_data(const std::string& text, const ReadOptions&, const Context& context) {
  const fs::path path = text;
  Scene scene = read_gltf(path, context);
  ReadValue read{{path.stem().string(), ModelData{MorphableModel(*scene.model)}, {.path = path}},
                 std::move(scene.files),
                 std::move(scene.notes)};
  std::ranges::move(scene.model_notes, std::back_inserter(read.notes));
  const BlendshapeModel& model = *scene.model;
  std::ranges::move(notes_on_expressions(read.value.name, model.neutral(), model.triangles(),
                                         model.expressions()),
                    std::back_inserter(read.notes));
  return read;
}

Format::Paths write_model_data(const Data& data, const fs::path& target,
                               const WriteOptions& options, const Context& context) {
  const auto& [model, performance, landmarks] = std::get<ModelData>(data);
  return write_gltf_model(model, performance, target, options, context);
}

}  // namespace

std::vector<Format> gltf_formats() {
  Format sequence{.name = "glTF 2.0",
                  .extensions = {".glb", ".gltf"},
                  .reading = reading_parameters(),
                  .open = open_scene};
  Format avatar = sequence;
  avatar.name = "VRM avatar, read as glTF";
  avatar.extensions = {".vrm"};
  sequence.create = begin_gltf;
  sequence.create_animation = write_gltf;
  // FB_ngon_encoding stores polygons.
  sequence.holds = [](const WriteOptions&) {
    return HeldParts{.polygons = true,
                     .texture = HeldParts::Texture::vertices,
                     .bare_faces = false,
                     .exact_times = false};
  };
  Format model{.name = sequence.name,
               .kind = DataKind::model,
               .extensions = sequence.extensions,
               .read = read_model_data,
               .write = write_model_data};
  Format avatar_model{.name = avatar.name,
                      .kind = DataKind::model,
                      .extensions = avatar.extensions,
                      .read = read_model_data};
  return {std::move(sequence), std::move(avatar), std::move(model), std::move(avatar_model)};
}

}  // namespace mimetra
