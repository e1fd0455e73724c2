#include "toolkit/io/pending_output.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>

#include <unistd.h>

#include "toolkit/io/temporary_name.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/io/written_files.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// "out/" and "out" are one target; only the second has a name to build the temporary one from.
fs::path without_trailing_slash(fs::path path) {
  path = path.lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

constexpr const char* kExistsAlready = "exists already; use --force to replace it";

/// Without links, dots and a slash at the end, as far as the file system tells.
fs::path place_of(const fs::path& path) {
  std::error_code error;
  const fs::path place = fs::weakly_canonical(fs::absolute(path, error), error);
  return without_trailing_slash(error ? path : place);
}

/// True for a path below `folder`, and for that itself.
bool is_within(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

/// What writing `output` would do to one of `inputs`; empty where they all stay.
std::string harm_to(const std::vector<fs::path>& inputs, const fs::path& output) {
  const fs::path place = place_of(output);
  std::error_code unreadable;
  for (const fs::path& input : inputs) {
    const fs::path read = place_of(input);
    std::string what;
    if (read == place) {
      what = "is an input of this run";
    } else if (is_within(read, place)) {
      what = "holds " + input.string() + ", an input of this run";
    } else if (is_within(place, read) && fs::exists(place, unreadable)) {
      what = "is a part of " + input.string() + ", an input of this run";
    }
    if (!what.empty()) return what + "; choose another name";
  }
  return {};
}

std::string cannot_write(const std::error_code& error) {
  return "cannot be written: " + error.message();
}

std::error_code last_error() {
  return {errno, std::generic_category()};
}

/// Throws for a folder, now in the place `folder`, that holds what would be lost with it.
void check_replaceable(const fs::path& target, const fs::path& folder) {
  const std::vector<fs::path> others = files_of_others(folder);
  if (others.empty()) return;
  std::vector<std::string> quoted_names;
  for (const fs::path& other : others) quoted_names.push_back("'" + other.string() + "'");
  throw OutputError(target.string(),
                    "holds " + listed(quoted_names, 3) +
                        ", which no manifest of an earlier run lists; --force replaces nothing "
                        "else: move what is yours, or choose another name");
}

void rename_or_throw(const fs::path& from, const fs::path& to, const fs::path& target) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw OutputError(target.string(), cannot_write(error));
}

}  // namespace

PendingOutput::PendingOutput(fs::path target, Kind kind, bool overwrite)
    : target_(without_trailing_slash(std::move(target))),
      temporary_(temporary_beside(target_)),
      kind_(kind),
      overwrite_(overwrite) {
  check_target();
  try {
    create_parents();
    create_temporary();
  } catch (...) {
    discard();
    throw;
  }
}

PendingOutput::~PendingOutput() {
  if (!committed_) discard();
}

void PendingOutput::check_target() const {
  std::error_code error;
  const fs::file_status status = fs::status(target_, error);
  if (!target_.has_filename()) {
    throw OutputError(target_.string(), "cannot be written: it names no file");
  }
  if (!fs::exists(status)) return;
  if (!overwrite_) throw OutputError(target_.string(), kExistsAlready);
  if (kind_ == Kind::folder && !fs::is_directory(status)) {
    throw OutputError(target_.string(), "exists and is no folder; remove it first");
  }
  if (kind_ == Kind::folder) check_replaceable(target_, target_);
  // Renaming onto a device such as /dev/null would replace the device.
  if (kind_ == Kind::file && !fs::is_regular_file(status)) {
    throw OutputError(target_.string(), "exists and is no ordinary file; choose another name");
  }
}

void PendingOutput::create_parents() {
  std::vector<fs::path> missing;
  std::error_code unreadable;
  for (fs::path parent = target_.parent_path(); !parent.empty() && !fs::exists(parent, unreadable);
       parent = parent.parent_path()) {
    missing.insert(missing.begin(), parent);
  }
  for (const fs::path& parent : missing) {
    std::error_code error;
    if (fs::create_directory(parent, error)) created_parents_.push_back(parent);
    if (error) throw OutputError(target_.string(), cannot_write(error));
  }
}

void PendingOutput::create_temporary() {
  std::error_code error;
  if (kind_ == Kind::folder) {
    fs::create_directory(temporary_, error);
  } else if (!std::ofstream(temporary_, std::ios::binary)) {
    error = last_error();
  }
  if (error) throw OutputError(target_.string(), cannot_write(error));
}

void PendingOutput::commit() {
  if (kind_ == Kind::folder) list_written_files(temporary_);
  check_target();
  std::error_code ignored;
  if (kind_ == Kind::folder && fs::exists(target_, ignored)) {
    replace_folder();
  } else {
    rename_or_throw(temporary_, target_, target_);
  }
  committed_ = true;
}

/// A folder with content cannot be renamed over: the old one steps aside and comes back if the new
/// one cannot take its place.
void PendingOutput::replace_folder() {
  const fs::path aside = temporary_beside(target_);
  rename_or_throw(target_, aside, target_);
  try {
    check_replaceable(target_, aside);  // from here on nobody puts anything there
    rename_or_throw(temporary_, target_, target_);
  } catch (const OutputError&) {
    std::error_code ignored;
    fs::rename(aside, target_, ignored);
    throw;
  }
  std::error_code ignored;
  fs::remove_all(aside, ignored);
}

void PendingOutput::discard() {
  std::error_code ignored;
  fs::remove_all(temporary_, ignored);
  // Removing fails, as it should, where somebody else has put something.
  for (auto parent = created_parents_.rbegin(); parent != created_parents_.rend(); ++parent) {
    fs::remove(*parent, ignored);
  }
}

PendingOutputs::PendingOutputs(bool overwrite, std::vector<fs::path> inputs)
    : overwrite_(overwrite), inputs_(std::move(inputs)) {}

/// The first one made the parent folders and can remove them only when the others are gone.
PendingOutputs::~PendingOutputs() {
  while (!outputs_.empty()) outputs_.pop_back();
}

const fs::path& PendingOutputs::add(const fs::path& target, PendingOutput::Kind kind,
                                    Existing existing) {
  const bool overwrite = overwrite_ || existing != Existing::nothing;
  outputs_.push_back(std::make_unique<PendingOutput>(target, kind, overwrite));
  if (!overwrite_ && existing == Existing::same) must_be_same_.push_back(outputs_.back().get());
  return outputs_.back()->path();
}

void PendingOutputs::add_stale(const fs::path& path) {
  std::error_code unreadable;
  if (!fs::exists(path, unreadable)) return;
  if (!overwrite_) throw OutputError(path.string(), kExistsAlready);
  stale_.push_back(path);
}

void PendingOutputs::commit() {
  check_same();
  check_inputs_stay();
  for (const auto& output : outputs_) output->check_target();
  for (const fs::path& path : stale_) {
    std::error_code error;
    fs::remove(path, error);
    if (error) throw OutputError(path.string(), "cannot be removed: " + error.message());
  }
  for (auto output = outputs_.rbegin(); output != outputs_.rend(); ++output) (*output)->commit();
}

void PendingOutputs::check_same() const {
  for (const PendingOutput* output : must_be_same_) {
    std::error_code unreadable;
    if (!fs::exists(output->target(), unreadable)) continue;
    if (read_file(output->target()) == read_file(output->path())) continue;
    throw OutputError(output->target().string(), kExistsAlready);
  }
}

void PendingOutputs::check_inputs_stay() const {
  for (const fs::path& path : stale_) mimetra::check_inputs_stay(path, inputs_);
  for (const auto& output : outputs_) {
    const std::string harm = harm_to(inputs_, output->target());
    if (harm.empty()) continue;
    std::error_code unreadable;
    const bool is_file = fs::is_regular_file(output->target(), unreadable);
    // A rest pose that was read is written again as it was.
    if (is_file && read_file(output->target()) == read_file(output->path())) continue;
    throw OutputError(output->target().string(), harm);
  }
}

void check_inputs_stay(const fs::path& output, const std::vector<fs::path>& inputs) {
  const std::string harm = harm_to(inputs, output);
  if (!harm.empty()) throw OutputError(output.string(), harm);
}

void write_file(const fs::path& target, std::string_view content, bool overwrite) {
  PendingOutput output(target, PendingOutput::Kind::file, overwrite);
  write_bytes(output.path(), content);
  output.commit();
}

}  // namespace mimetra
