#include "toolkit/formats/driven_sequence.h"

#include "toolkit/io/fit_file.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// Throws MismatchError for a model without expressions, which `driver` cannot move, if meshes in
/// its folder look like expressions.
void check_has_expressions(const BlendshapeModel& person, const fs::path& path,
                           const fs::path& driver) {
  if (person.expressions().size() > 0) return;
  for (const std::string& unread : notes_on_unread(path)) {
    throw MismatchError(driver.string() + ": drives nothing; " + unread);
  }
}

}  // namespace

OpenSequence open_driven(const ModelSpec& spec, const ReadOptions& options,
                         const Context& context) {
  auto person = std::make_shared<const BlendshapeModel>(read_person(spec, context));
  if (const auto driver = options.weights ? options.weights : spec.fit) {
    check_has_expressions(*person, spec.path, *driver);
  }
  OpenSequence open;
  if (!spec.fit) {
    open = drive(std::move(person), spec.path, options);
  } else if (!options.weights) {
    open =
        drive(std::move(person), spec.path, options, *spec.fit, read_fit(*spec.fit).performance());
  } else {
    open = drive(std::move(person), spec.path, options);
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

}  // namespace mimetra
