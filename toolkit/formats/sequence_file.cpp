#include "toolkit/formats/sequence_file.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "toolkit/formats/driven_sequence.h"
#include "toolkit/formats/formats.h"
#include "toolkit/formats/gltf/scene.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/frame_times.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/animation.h"
#include "toolkit/model/expression_notes.h"

namespace mimetra {
namespace fs = std::filesystem;

namespace {

/// Extensions of the formats with such a function.
template <typename Function>
std::vector<std::string> extensions_of(Function Format::*function) {
  std::vector<std::string> all;
  for (const Format& format : formats()) {
    if (!(format.*function) || format.has(Format::kFolder)) continue;
    all.insert(all.end(), format.extensions.begin(), format.extensions.end());
  }
  return all;
}

/// Throws MismatchError if there are weights, since `text` is not a model that they could drive.
void check_undriven(const std::string& text, const ReadOptions& options) {
  if (!options.weights) return;
  throw MismatchError(text + " is no model that the weights of " + options.weights->string() +
                      " could drive; expected a folder with a neutral and expressions");
}

OpenSequence open_path(const fs::path& path, const ReadOptions& options, const Context& context) {
  const Format* format = fs::is_directory(path) ? &folder_of_meshes() : sequence_format(path);
  if (format) require_built(*format, path.string());
  if (format && format->open) return format->open(path, options, context);
  const std::string found = foreign_file(path);
  throw IoError(path.string(), found.empty()
                                   ? "is no sequence; expected a folder, " +
                                         joined(extensions_of(&Format::open)) + " or a model"
                                   : "is " + found);
}

/// Throws IoError for a name that marks digits by a sign other than printf's.
void check_digits(const std::string& text) {
  const fs::path file(text);
  const std::string name = file.filename().string();
  const bool has_placeholder = name.find_first_of("#@$[{") != std::string::npos;
  if (!has_placeholder || !is_mesh_extension(file.extension().string())) return;
  const fs::path pattern = file.parent_path() / ("frame_%04d" + file.extension().string());
  throw IoError(text, "no such file or folder; numbered files are named by a pattern such as '" +
                          pattern.string() + "'");
}

OpenSequence opened(const std::string& text, const ReadOptions& options, const Context& context) {
  const bool exists = is_there(text);
  if (exists && is_scene_file(text)) return open_path(text, options, context);
  if (exists && is_model(text)) return open_driven(ModelSpec{text, {}, {}}, options, context);
  if (!exists && !is_frame_pattern(text)) check_digits(text);
  if (!exists && !is_frame_pattern(text) && text.find('@') != std::string::npos) {
    const ModelSpec spec = ModelSpec::parse(text);
    if (is_there(spec.path) && !is_model(spec.path)) {
      throw IoError(spec.path.string(), "is no model, so that nothing can follow '@'");
    }
    return open_driven(spec, options, context);
  }
  if (!exists && !is_frame_pattern(text)) fail_missing(text);
  check_undriven(text, options);
  return exists ? open_path(text, options, context)
                : open_frames(frames_of_pattern(text), {}, options, context);
}

}  // namespace

OpenSequence open_sequence(const std::string& text, const ReadOptions& options,
                           const Context& context) {
  check_options(options);
  if (options.weight_scale && !options.weights) {
    throw std::invalid_argument(text +
                                ": option 'weight-scale' is a factor of the weights that "
                                "option 'weights' names; leave it out, or give both");
  }
  OpenSequence open = opened(text, options, context);
  if (const auto* animation = dynamic_cast<const Animation*>(open.frames.get())) {
    const BlendshapeModel& model = animation->model();
    for (const std::string& note :
         notes_on_expressions(text, model.neutral(), model.triangles(), model.expressions())) {
      open.notes.push_back(note);
    }
  }
  // Times of weights were checked before, and selected frames may be far apart.
  if (open.model_driven || options.frames) return open;
  if (const std::string odd = note_on_steps(open.frames->known_times()); !odd.empty()) {
    open.notes.push_back(text + ": " + odd);
  }
  return open;
}

SequenceRead read_sequence(const std::string& text, const ReadOptions& options,
                           const Context& context) {
  OpenSequence open = open_sequence(text, options, context.part(0, 0));
  SequenceRead read{MeshSequence(*open.frames, context), open.model_driven, std::move(open.files),
                    std::move(open.notes), std::move(open.fields)};
  context.report(1);
  return read;
}

std::unique_ptr<FrameSink> begin_sequence(const SequenceHeader& header, const fs::path& target,
                                          const WriteOptions& options, const Context& context) {
  check_options(options);
  if (header.times.size() == 0) throw std::invalid_argument("the sequence has no frames");
  const Format* format = target.extension().empty() ? &folder_of_meshes() : sequence_format(target);
  if (format) require_built(*format, target.string());
  if (format && format->create) return format->create(header, target, options, context);
  throw std::invalid_argument(target.string() + ": no sequence can be written as '" +
                              target.extension().string() + "', expected " +
                              joined(extensions_of(&Format::create)) +
                              "; a folder of this name is '" + target.string() + "/'");
}

ReadValue read_sequence_value(const std::string& text, const ReadOptions& options,
                              const Context& context) {
  OpenSequence open = open_sequence(text, options, context);
  FieldSequence sequence(std::move(open.frames), std::move(open.fields));
  return {{text, std::move(sequence), {.model_driven = open.model_driven}},
          std::move(open.files),
          std::move(open.notes)};
}

Format::Paths write_sequence_value(const Data& data, const fs::path& target,
                                   const WriteOptions& options, const Context& context) {
  const auto& sequence = std::get<FieldSequence>(data);
  WriteOptions with_fields = options;
  with_fields.fields = sequence.fields;
  return write_sequence(*sequence.frames, target, with_fields, context);
}

std::vector<fs::path> write_sequence(const FrameSource& sequence, const fs::path& target,
                                     const WriteOptions& options, const Context& context) {
  if (const auto* animation = dynamic_cast<const Animation*>(&sequence)) {
    const Format* format = sequence_format(target);
    if (format && format->create_animation && animation->model().expressions().size() > 0) {
      check_options(options);
      return format->create_animation(*animation, target, options, context);
    }
  }
  const auto sink = begin_sequence(sequence.header(), target, options, context.part(0, 0));
  context.report(0);
  for_each_block(
      sequence, [&sink](int first, const Frames& poses) { sink->write(first, poses); },
      context.without_ranks());
  context.report(1);
  return sink->commit();
}

namespace {

constexpr const char* kCorrespondenceSuffix = ".correspondence.json";

/// Suffixes of the further files of a format.
std::vector<std::string> own_suffixes_of(const fs::path& file) {
  const std::string extension = lower_extension(file);
  if (extension == ".gltf") return {".bin"};
  if (extension == ".pvd") return {".vtp.series"};
  return {};
}

/// Suffixes of all files that a sequence may be written with.
std::vector<std::string> suffixes_of(const fs::path& sequence) {
  std::vector<std::string> suffixes = {kCorrespondenceSuffix};
  const std::string extension = lower_extension(sequence);
  if (extension.empty()) suffixes.clear();  // a folder holds it
  if (extension.empty() || has_companions(sequence)) {
    suffixes.insert(suffixes.end(), {kRestSuffix, kTimesSuffix});
  }
  if (has_companions(sequence)) suffixes.emplace_back(kTopologySuffix);
  for (std::string& own : own_suffixes_of(sequence)) suffixes.push_back(std::move(own));
  return suffixes;
}

std::vector<std::string> refused_beside(const fs::path& file,
                                        const std::vector<std::string>& suffixes, bool overwrite) {
  const fs::path main = file.has_filename() ? file : file.parent_path();
  std::vector<std::string> refused;
  for (const std::string& suffix : suffixes) {
    const bool has_owner =
        suffix == kRestSuffix || suffix == kTimesSuffix || suffix == kTopologySuffix;
    const fs::path path =
        has_owner ? beside(file, suffix) : fs::path(main).replace_extension(suffix);
    if (!is_there(path)) continue;
    const std::string reason =
        why_to_keep(main, has_owner ? other_of_name(file) : fs::path(), overwrite);
    if (reason.empty()) continue;
    refused.push_back(path.string() + ": " + reason +
                      "; a run that writes another content there is refused");
  }
  return refused;
}

}  // namespace

std::vector<std::string> refused_companions(const fs::path& sequence, bool overwrite) {
  return refused_beside(sequence, suffixes_of(sequence), overwrite);
}

std::vector<std::string> refused_parts(const fs::path& file, bool overwrite, bool may_be_paired) {
  std::vector<std::string> suffixes = own_suffixes_of(file);
  if (may_be_paired && !lower_extension(file).empty()) suffixes.emplace_back(kCorrespondenceSuffix);
  return refused_beside(file, suffixes, overwrite);
}

}  // namespace mimetra
