#include "toolkit/io/pending_output.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "toolkit/io/whole_file.h"
#include "toolkit/io/written_files.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// Resolves links, and replaces "." and ".." by the folder's name. Throws OutputError for a
/// dangling link.
fs::path real_target(const fs::path& target) {
  fs::path real = without_trailing_slash(target);
  std::error_code error;
  if (real.filename() == "." || real.filename() == "..") {
    real = without_trailing_slash(fs::absolute(real, error));
  }
  if (!fs::is_symlink(fs::symlink_status(real, error))) return real;
  const fs::path leads_to = fs::canonical(real, error);
  if (!error) return leads_to;
  throw OutputError(real.string(),
                    "is a link that leads nowhere; make what it should lead to, or remove it");
}

constexpr const char* kExistsAlready = "exists already; use option 'overwrite' to replace it";

/// Device and inode, which identify a file or folder whatever its path.
using FileId = std::pair<dev_t, ino_t>;

std::optional<FileId> id_of(const fs::path& path) {
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0) return std::nullopt;
  return FileId(status.st_dev, status.st_ino);
}

/// Path without links, dots and a trailing slash, as far as the file system can resolve it.
fs::path place_of(const fs::path& path) {
  std::error_code error;
  const fs::path place = fs::weakly_canonical(fs::absolute(path, error), error);
  return without_trailing_slash(error ? path : place);
}

/// Existing folders that contain a place, outermost last.
std::vector<FileId> folders_around(const fs::path& place) {
  std::vector<FileId> ids;
  for (fs::path folder = place; folder != folder.parent_path();) {
    folder = folder.parent_path();
    if (const auto id = id_of(folder)) ids.push_back(*id);
  }
  return ids;
}

bool holds(const std::vector<FileId>& ids, const FileId& id) {
  return std::ranges::find(ids, id) != ids.end();
}

/// Damage that writing `output` would do to one of `inputs`; empty if there is none. Compares
/// identities, since a folder may be mounted twice and some file systems ignore case.
std::string harm_to(const std::vector<fs::path>& inputs, const fs::path& output) {
  const fs::path place = place_of(output);
  const std::optional<FileId> id = id_of(place);
  const std::vector<FileId> around = folders_around(place);
  for (const fs::path& input : inputs) {
    const fs::path read = place_of(input);
    const std::optional<FileId> of_input = id_of(read);
    std::string what;
    if (id && id == of_input) {
      what = "is an input of this run";
    } else if (id && holds(folders_around(read), *id)) {
      what = "holds " + input.string() + ", an input of this run";
    } else if (of_input && holds(around, *of_input)) {
      what = std::string(id ? "is" : "would become") + " a part of " + input.string() +
             ", an input of this run";
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

/// Throws OutputError if the folder, now at `folder`, contains files that replacing it would lose.
void check_replaceable(const fs::path& target, const fs::path& folder) {
  const std::vector<fs::path> others = files_of_others(folder);
  if (others.empty()) return;
  std::vector<std::string> quoted_names;
  quoted_names.reserve(others.size());
  for (const fs::path& other : others) quoted_names.push_back("'" + other.string() + "'");
  throw OutputError(target.string(),
                    "holds " + listed(quoted_names, 3) +
                        ", which no manifest of an earlier run lists, so that it cannot be "
                        "replaced: move what is yours, or choose another name");
}

/// Renames in one step. RENAME_EXCHANGE swaps the two names, and RENAME_NOREPLACE never replaces.
/// Some network file systems support neither.
std::error_code rename_by(const fs::path& from, const fs::path& to, unsigned flags) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), flags) == 0) return {};
  return last_error();
}

bool is_unknown(const std::error_code& error) {
  return error == std::errc::invalid_argument || error == std::errc::function_not_supported ||
         error == std::errc::operation_not_supported;
}

std::error_code exchange(const fs::path& temporary, const fs::path& target) {
  std::error_code error = rename_by(temporary, target, RENAME_EXCHANGE);
  if (!is_unknown(error)) return error;
  const fs::path aside = temporary.string() + ".old";
  // A second name keeps the target alive while its first name changes hands. Folders, and files on
  // some file systems, cannot have two names.
  if (!fs::is_directory(target, error)) fs::create_hard_link(target, aside, error);
  const bool is_linked = fs::exists(aside, error);
  if (!is_linked) fs::rename(target, aside, error);
  if (error) return error;
  fs::rename(temporary, target, error);
  std::error_code ignored;
  fs::rename(aside, error ? target : temporary, ignored);
  if (is_linked) fs::remove(aside, ignored);  // renaming between two names of one file does nothing
  return error;
}

std::error_code put(const fs::path& temporary, const fs::path& target) {
  std::error_code error = rename_by(temporary, target, RENAME_NOREPLACE);
  if (!is_unknown(error)) return error;
  if (fs::exists(fs::symlink_status(target, error))) {
    return std::make_error_code(std::errc::file_exists);
  }
  fs::rename(temporary, target, error);
  return error;
}

/// Removes `path` and ignores all errors, since nothing can be done about them.
void remove_quietly(const fs::path& path) noexcept {
  try {
    std::error_code ignored;
    if (fs::is_directory(fs::symlink_status(path, ignored))) {
      fs::permissions(path, fs::perms::owner_all, fs::perm_options::add, ignored);
    }
    fs::remove_all(path, ignored);
  } catch (const std::bad_alloc&) {
    return;
  }
}

/// Temporary names in use, and folders made for them, outer folders first. For
/// remove_pending_outputs().
struct TemporaryNames {
  std::mutex mutex;
  std::set<fs::path> names;
  std::vector<fs::path> parents;
};

TemporaryNames& temporary_names() {
  static auto* const names = new TemporaryNames;  // outlives all outputs
  return *names;
}

void remember(const fs::path& temporary) {
  const std::scoped_lock lock(temporary_names().mutex);
  temporary_names().names.insert(temporary);
}

void forget(const fs::path& temporary) {
  const std::scoped_lock lock(temporary_names().mutex);
  temporary_names().names.erase(temporary);
}

/// Locked while outputs take their places.
std::mutex& commit_mutex() {
  static auto* const mutex = new std::mutex;  // outlives all outputs
  return *mutex;
}

/// File or folder that is open during this object's lifetime; -1 if it cannot be opened.
class OpenFile {
 public:
  OpenFile(const fs::path& path, int flags) : number_(open(path.c_str(), flags | O_CLOEXEC)) {}
  ~OpenFile() {
    if (number_ >= 0) close(number_);
  }
  OpenFile(OpenFile&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  OpenFile& operator=(OpenFile&&) = delete;

  int number() const { return number_; }

 private:
  int number_;
};

std::set<fs::path> folders_of(const std::vector<PendingOutput*>& outputs) {
  std::set<fs::path> folders;
  for (const PendingOutput* output : outputs) {
    folders.insert(fs::absolute(output->target()).parent_path());
  }
  return folders;
}

/// Keeps other runs from committing in the same folders, if the file system supports locks. A
/// folder with two paths is locked once.
class FolderLocks {
 public:
  explicit FolderLocks(const std::set<fs::path>& folders) {
    std::map<FileId, fs::path> each;  // sorted, so that all runs lock in one order
    for (const fs::path& folder : folders) {
      if (const auto id = id_of(folder)) each.emplace(*id, folder);
    }
    for (const auto& [id, folder] : each) lock(folder);
  }

 private:
  /// Waits up to 10 s, since the owner of a lock only renames a few files.
  void lock(const fs::path& folder) {
    constexpr int kAttempts = 1000;
    const OpenFile& opened = opened_.emplace_back(folder, O_RDONLY | O_DIRECTORY);
    if (opened.number() < 0) return;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      if (flock(opened.number(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

  std::vector<OpenFile> opened_;
};

/// Largest number of files in an output that are synced one by one. Above it, their whole file
/// system is synced.
constexpr std::size_t kSyncedFiles = 8;

/// The path itself and, for a folder, all files and folders below it.
std::vector<fs::path> all_within(const fs::path& path) {
  std::vector<fs::path> all = {path};
  std::error_code error;
  if (!fs::is_directory(path, error)) return all;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path)) {
    if (!entry.is_symlink()) all.push_back(entry.path());
  }
  return all;
}

/// Syncs contents to the disk, so that no name leads to an empty file after a power cut. Ignores
/// file systems that cannot sync. Throws OutputError if the disk fails.
void sync_content(const std::vector<PendingOutput*>& outputs) {
  std::set<dev_t> synced;
  for (const PendingOutput* output : outputs) {
    const std::vector<fs::path> all = all_within(output->path());
    const auto sync = [&](const fs::path& path, int (*call)(int)) {
      const OpenFile file(path, O_RDONLY);
      if (file.number() < 0 || call(file.number()) == 0) return;
      if (errno == EIO || errno == ENOSPC || errno == EDQUOT) {
        throw OutputError(output->target().string(), cannot_write(last_error()));
      }
    };
    if (all.size() <= kSyncedFiles) {
      for (const fs::path& path : all) sync(path, fdatasync);
    } else if (const auto id = id_of(output->path()); id && synced.insert(id->first).second) {
      sync(output->path(), syncfs);
    }
  }
}

void sync_names(const std::set<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    const OpenFile opened(folder, O_RDONLY | O_DIRECTORY);
    if (opened.number() >= 0) fsync(opened.number());
  }
}

}  // namespace

PendingOutput::PendingOutput(const fs::path& target, Kind kind, bool overwrite)
    : target_(real_target(target)), kind_(kind), overwrite_(overwrite) {
  check_target();
  try {
    create_temporary();
  } catch (...) {
    discard();
    throw;
  }
}

PendingOutput::~PendingOutput() {
  give_place_back();
  if (stage_ == Stage::pending) discard();
}

void PendingOutput::check_target() const {
  std::error_code error;
  const fs::file_status status = fs::status(target_, error);
  if (!target_.has_filename()) {
    throw OutputError(target_.string(), "cannot be written: it names no file");
  }
  if (!fs::exists(status)) return;
  if (kind_ == Kind::folder && !fs::is_directory(status)) {
    throw OutputError(target_.string(), "exists and is no folder; choose another name");
  }
  // Renaming onto a device such as /dev/null would replace it.
  if (kind_ == Kind::file && !fs::is_regular_file(status)) {
    throw OutputError(target_.string(), "exists and is no ordinary file; choose another name");
  }
  // Report first what the option 'overwrite' would not solve.
  if (kind_ == Kind::folder) check_replaceable(target_, target_);
  if (!overwrite_) throw OutputError(target_.string(), kExistsAlready);
}

std::error_code PendingOutput::create_parents() {
  std::vector<fs::path> missing;
  std::error_code error;
  for (fs::path parent = target_.parent_path(); !parent.empty() && !fs::exists(parent, error);
       parent = parent.parent_path()) {
    missing.insert(missing.begin(), parent);
  }
  for (const fs::path& parent : missing) {
    if (fs::create_directory(parent, error)) {
      created_parents_.push_back(parent);
      const std::scoped_lock lock(temporary_names().mutex);
      temporary_names().parents.push_back(parent);
    }
    if (error) return error;
  }
  return {};
}

/// Retries, because another run may remove parent folders that it created and found empty.
void PendingOutput::create_temporary() {
  constexpr int kAttempts = 100;
  std::error_code error;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    error = create_parents();
    if (!error) temporary_ = make_temporary_beside(target_, kind_, error);
    if (error != std::errc::no_such_file_or_directory && error != std::errc::file_exists) break;
  }
  if (error) throw OutputError(target_.string(), cannot_write(error));
  remember(temporary_);
}

void PendingOutput::complete() {
  if (kind_ == Kind::folder) list_written_files(temporary_);
}

void PendingOutput::take_place() {
  check_target();
  std::error_code error;
  const fs::file_status replaced = fs::symlink_status(target_, error);
  const bool replaces = fs::exists(replaced);
  if (replaces) fs::permissions(temporary_, replaced.permissions(), error);
  error = replaces ? exchange(temporary_, target_) : put(temporary_, target_);
  if (error == std::errc::file_exists) throw OutputError(target_.string(), kExistsAlready);
  if (error) throw OutputError(target_.string(), cannot_write(error));
  stage_ = replaces ? Stage::stands_for_another : Stage::stands_where_nothing_was;
  if (!replaces || kind_ == Kind::file) return;
  try {
    check_replaceable(target_, temporary_);  // the old folder can no longer gain files
  } catch (const OutputError&) {
    give_place_back();
    throw;
  }
}

void PendingOutput::give_place_back() noexcept {
  if (stage_ == Stage::stands_for_another) {
    exchange(temporary_, target_);
  } else if (stage_ == Stage::stands_where_nothing_was) {
    put(target_, temporary_);
  } else {
    return;
  }
  stage_ = Stage::pending;
}

void PendingOutput::keep_place() noexcept {
  if (stage_ == Stage::stands_for_another) remove_quietly(temporary_);
  forget(temporary_);
  stage_ = Stage::kept;
}

void PendingOutput::commit() {
  complete();
  const std::scoped_lock lock(commit_mutex());
  take_place();
  keep_place();
}

void PendingOutput::discard() noexcept {
  if (!temporary_.empty()) {
    remove_quietly(temporary_);
    forget(temporary_);
  }
  std::error_code ignored;
  // Removal fails, as intended, if someone else has put files there.
  for (auto parent = created_parents_.rbegin(); parent != created_parents_.rend(); ++parent) {
    fs::remove(*parent, ignored);
  }
}

PendingOutputs::PendingOutputs(bool overwrite, std::vector<fs::path> inputs,
                               PendingOutputs* together)
    : overwrite_(overwrite), inputs_(std::move(inputs)), together_(together) {}

/// Destroys the outputs in reverse order. The first one made the parent folders and can remove them
/// only when the others are gone.
PendingOutputs::~PendingOutputs() {
  while (!entries_.empty()) entries_.pop_back();
}

const fs::path& PendingOutputs::add(const fs::path& target, PendingOutput::Kind kind,
                                    Existing existing, const fs::path& owner) {
  const bool overwrite = overwrite_ || existing != Existing::nothing;
  std::string unless_same;
  if (existing == Existing::same) unless_same = reason_to_keep(owner);
  entries_.push_back({std::make_unique<PendingOutput>(target, kind, overwrite),
                      std::move(unless_same), existing == Existing::anything});
  return entries_.back().output->path();
}

void PendingOutputs::add_stale(const fs::path& path, const fs::path& owner) {
  if (!is_there(path)) return;
  if (const std::string reason = reason_to_keep(owner); !reason.empty()) {
    throw OutputError(path.string(), reason);
  }
  stale_.push_back(path);
}

/// Reason to keep an existing companion of the main output; empty if it may be replaced.
std::string PendingOutputs::reason_to_keep(const fs::path& owner) const {
  return why_to_keep(entries_.empty() ? fs::path() : entries_.front().output->target(), owner,
                     overwrite_);
}

void PendingOutputs::commit() {
  for (const Entry& entry : entries_) entry.output->complete();
  if (together_) {
    check();
    hand_over();
    return;
  }
  drop_repeated();
  const std::vector<PendingOutput*> outputs = in_order();
  sync_content(outputs);
  const FolderLocks locks(folders_of(outputs));
  check();  // checks again, since other runs may have written meanwhile
  swap(outputs);
  sync_names(folders_of(outputs));
}

void PendingOutputs::check() const {
  check_same();
  check_inputs_stay();
  for (const Entry& entry : entries_) entry.output->check_target();
}

void PendingOutputs::hand_over() {
  for (Entry& entry : entries_) together_->entries_.push_back(std::move(entry));
  entries_.clear();
  together_->stale_.insert(together_->stale_.end(), stale_.begin(), stale_.end());
}

/// Outputs of one run may share a manifest, which is kept once.
void PendingOutputs::drop_repeated() {
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    const PendingOutput& output = *entry->output;
    const auto first = std::ranges::find(entries_, output.target(),
                                         [](const Entry& other) { return other.output->target(); });
    if (first == entry) {
      ++entry;
      continue;
    }
    if (output.kind() != PendingOutput::Kind::file || first->output->kind() != output.kind() ||
        read_file(output.path()) != read_file(first->output->path())) {
      throw OutputError(output.target().string(), "two outputs would be written there");
    }
    entry = entries_.erase(entry);
  }
}

/// Reverse order of add(), with the files that describe outputs last.
std::vector<PendingOutput*> PendingOutputs::in_order() const {
  std::vector<PendingOutput*> order;
  for (const bool tells : {false, true}) {
    for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) {
      if (entry->tells_of_another == tells) order.push_back(entry->output.get());
    }
  }
  return order;
}

/// Moves all outputs to their places, or none.
void PendingOutputs::swap(const std::vector<PendingOutput*>& order) {
  const std::scoped_lock lock(commit_mutex());
  try {
    std::set<FileId> taken;
    for (PendingOutput* output : order) {
      const auto id = id_of(output->target());
      if (id && taken.contains(*id)) {
        throw OutputError(output->target().string(), "two outputs would be written there");
      }
      output->take_place();
      if (const auto now = id_of(output->target())) taken.insert(*now);
    }
  } catch (...) {
    for (auto output = order.rbegin(); output != order.rend(); ++output) {
      (*output)->give_place_back();
    }
    throw;
  }
  for (const fs::path& path : stale_) {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
  for (PendingOutput* output : order) output->keep_place();
}

void PendingOutputs::check_same() const {
  for (const auto& [output, unless_same, tells_of_another] : entries_) {
    if (unless_same.empty() || !is_there(output->target())) continue;
    if (read_file(output->target()) == read_file(output->path())) continue;
    throw OutputError(output->target().string(), unless_same);
  }
}

void PendingOutputs::check_inputs_stay() const {
  for (const fs::path& path : stale_) mimetra::check_inputs_stay(path, inputs_);
  for (const Entry& entry : entries_) {
    const PendingOutput& output = *entry.output;
    const std::string harm = harm_to(inputs_, output.target());
    if (harm.empty()) continue;
    std::error_code unreadable;
    const bool is_file = fs::is_regular_file(output.target(), unreadable);
    // Writing back an input with the same content, such as a rest pose, is allowed.
    if (is_file && read_file(output.target()) == read_file(output.path())) continue;
    throw OutputError(output.target().string(), harm);
  }
}

void remove_pending_outputs() noexcept {
  commit_mutex().lock();  // never unlocked
  const std::scoped_lock lock(temporary_names().mutex);
  // Other threads may still be writing into a folder.
  constexpr int kAttempts = 3;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    for (const fs::path& name : temporary_names().names) remove_quietly(name);
  }
  std::error_code ignored;
  std::vector<fs::path>& parents = temporary_names().parents;
  // Folders that are not empty stay.
  for (auto parent = parents.rbegin(); parent != parents.rend(); ++parent) {
    fs::remove(*parent, ignored);
  }
}

void check_inputs_stay(const fs::path& output, const std::vector<fs::path>& inputs) {
  const std::string harm = harm_to(inputs, output);
  if (!harm.empty()) throw OutputError(without_trailing_slash(output).string(), harm);
}

std::string why_to_keep(const fs::path& main, const fs::path& owner, bool overwrite) {
  if (!owner.empty()) {
    return "belongs to '" + owner.filename().string() + "', which stays; choose another name";
  }
  if (!main.empty() && !is_there(main)) {
    return "stands without '" + main.filename().string() +
           "', a part of which it would be; move it, or choose another name";
  }
  return overwrite ? "" : kExistsAlready;
}

PendingOutputs::Existing existing_beside(std::string_view name) {
  const bool is_manifest = name.ends_with(".run.json") || name == kFolderManifest;
  return is_manifest ? PendingOutputs::Existing::anything : PendingOutputs::Existing::same;
}

void write_file(const fs::path& target, std::string_view content, bool overwrite,
                PendingOutputs* together) {
  PendingOutputs outputs(overwrite, {}, together);
  write_bytes(outputs.add(target, PendingOutput::Kind::file), content);
  outputs.commit();
}

}  // namespace mimetra
