#include "toolkit/io/sequence_file.h"

#include <stdexcept>
#include <utility>

#include "toolkit/io/fit_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/model_file.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/scene.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/animation.h"
#include "toolkit/model/expression_notes.h"

namespace mimetra {
namespace fs = std::filesystem;

namespace {

OpenSequence open_driven(const ModelSpec& spec, const SequenceSource& source,
                         const Context& context) {
  auto person = std::make_shared<const BlendshapeModel>(read_person(spec, context));
  OpenSequence open;
  if (!spec.fit) {
    open = drive(std::move(person), spec.path, source);
  } else if (!source.weights) {
    open =
        drive(std::move(person), spec.path, source, *spec.fit, read_fit(*spec.fit).performance());
  } else {
    open = drive(std::move(person), spec.path, source);
    open.files.insert(open.files.begin() + 1, *spec.fit);
  }
  const std::vector<std::string> of_spec = spec.notes();
  open.notes.insert(open.notes.begin(), of_spec.begin(), of_spec.end());
  if (const auto others = meshes_beside_model(spec.path); !others.empty()) {
    open.notes.push_back(spec.path.string() + ": is read as a model; " +
                         std::to_string(others.size()) + " other mesh files in it, from " +
                         others.front().filename().string() +
                         " on, are no part of it; name frames by a pattern");
  }
  const std::vector<std::string> unread = notes_on_unread(spec.path);
  open.notes.insert(open.notes.end(), unread.begin(), unread.end());
  return open;
}

/// Throws MismatchError if there are weights, since `text` is not a model that they could drive.
void check_undriven(const std::string& text, const SequenceSource& source) {
  if (!source.weights) return;
  throw MismatchError(text + " is no model that the weights of " + source.weights->string() +
                      " could drive; expected a folder with a neutral and expressions");
}

OpenSequence open_path(const fs::path& path, const SequenceSource& source, const Context& context) {
  if (fs::is_directory(path)) return open_frames(frames_of_folder(path), path, source, context);
  if (const SequenceFormat* format = sequence_format(path)) {
    return format->open(path, source, context);
  }
  const std::string found = foreign_file(path);
  throw IoError(path.string(), found.empty() ? "is no sequence; expected a folder, " +
                                                   joined(sequence_extensions()) + " or a model"
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

OpenSequence opened(const std::string& text, const SequenceSource& source, const Context& context) {
  const bool exists = is_there(text);
  if (exists && is_scene_file(text)) return open_scene(text, source, context);
  if (exists && is_model(text)) return open_driven(ModelSpec{text, {}, {}}, source, context);
  if (!exists && !is_frame_pattern(text)) check_digits(text);
  if (!exists && !is_frame_pattern(text) && text.find('@') != std::string::npos) {
    const ModelSpec spec = ModelSpec::parse(text);
    if (is_there(spec.path) && !is_model(spec.path)) {
      throw IoError(spec.path.string(), "is no model, so that nothing can follow '@'");
    }
    return open_driven(spec, source, context);
  }
  if (!exists && !is_frame_pattern(text)) fail_missing(text);
  check_undriven(text, source);
  return exists ? open_path(text, source, context)
                : open_frames(frames_of_pattern(text), {}, source, context);
}

}  // namespace

OpenSequence open_sequence(const std::string& text, const SequenceSource& source,
                           const Context& context) {
  check_options(source);
  if (source.weight_scale && !source.weights) {
    throw std::invalid_argument(text +
                                ": option 'weight-scale' is a factor of the weights that "
                                "option 'weights' names; leave it out, or give both");
  }
  OpenSequence open = opened(text, source, context);
  if (const auto* animation = dynamic_cast<const Animation*>(open.frames.get())) {
    const BlendshapeModel& model = animation->model();
    for (const std::string& note :
         notes_on_expressions(text, model.neutral(), model.triangles(), model.expressions())) {
      open.notes.push_back(note);
    }
  }
  // Times of weights were checked before, and selected frames may be far apart.
  if (open.model_driven || source.frames) return open;
  if (const std::string odd = note_on_steps(open.frames->known_times()); !odd.empty()) {
    open.notes.push_back(text + ": " + odd);
  }
  return open;
}

SequenceRead read_sequence(const std::string& text, const SequenceSource& source,
                           const Context& context) {
  OpenSequence open = open_sequence(text, source, context.part(0, 0));
  SequenceRead read{MeshSequence(*open.frames, context), open.model_driven, std::move(open.files),
                    std::move(open.notes)};
  context.report(1);
  return read;
}

std::unique_ptr<FrameSink> begin_sequence(const SequenceHeader& header, const fs::path& target,
                                          const SequenceWriteOptions& options,
                                          const ExtraFiles& extra, const Context& context) {
  check_options(options);
  if (header.times.size() == 0) throw std::invalid_argument("the sequence has no frames");
  if (target.extension().empty()) return begin_folder(header, target, options, extra, context);
  if (const SequenceFormat* format = sequence_format(target)) {
    return format->begin(header, target, options, extra, context);
  }
  throw std::invalid_argument(target.string() + ": no sequence can be written as '" +
                              target.extension().string() + "', expected " +
                              joined(sequence_extensions()) + "; a folder of this name is '" +
                              target.string() + "/'");
}

std::vector<fs::path> write_sequence(const FrameSource& sequence, const fs::path& target,
                                     const SequenceWriteOptions& options, const ExtraFiles& extra,
                                     const Context& context) {
  if (const auto* animation = dynamic_cast<const Animation*>(&sequence)) {
    const SequenceFormat* format = sequence_format(target);
    if (format && format->write_animation && animation->model().expressions().size() > 0) {
      check_options(options);
      return format->write_animation(*animation, target, options, extra, context);
    }
  }
  const auto sink = begin_sequence(sequence.header(), target, options, extra, context.part(0, 0));
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
  const SequenceFormat* format = sequence_format(sequence);
  if (extension.empty()) suffixes.clear();  // a folder holds it
  if (extension.empty() || (format && format->has_companions)) {
    suffixes.insert(suffixes.end(), {kRestSuffix, kTimesSuffix});
  }
  if (format && format->has_companions) suffixes.emplace_back(kTopologySuffix);
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
