#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "toolkit/io/binary_file.h"

namespace mimetra {

/// File or folder that appears under its name only when it is complete.
///
/// Callers write to `path()`, a temporary name in the same folder. The commit then replaces an
/// existing target in one step. If the process dies before, the target does not change. An object
/// that is destroyed before the commit removes what was written.
class PendingOutput {
 public:
  using Kind = OutputKind;

  /// Creates missing parent folders and the temporary file or folder. Throws OutputError if
  /// `target` exists without `overwrite`, if it cannot be written, or if a folder to overwrite
  /// contains anything that its manifest (written_files.h) does not list.
  PendingOutput(const std::filesystem::path& target, Kind kind, bool overwrite);
  ~PendingOutput();
  PendingOutput(const PendingOutput&) = delete;
  PendingOutput& operator=(const PendingOutput&) = delete;

  /// Hidden name without the target's extension, which committed_name() gives to writers.
  const std::filesystem::path& path() const { return temporary_; }
  const std::filesystem::path& target() const { return target_; }
  Kind kind() const { return kind_; }
  /// Throws OutputError if `target` is, or has become, one that the constructor refuses.
  void check_target() const;

  /// Completes the output: a folder gets a manifest that lists its files. Throws OutputError.
  void complete();
  /// Moves the output to its name; what was there gets the temporary name. The output takes over
  /// its permissions. Throws as check_target(), and then nothing has changed.
  /// \pre complete() was called
  void take_place();
  /// Undoes take_place(), if it was called.
  void give_place_back() noexcept;
  /// Keeps the place after take_place(), and removes what was there before.
  void keep_place() noexcept;
  /// Calls complete(), take_place() and keep_place(). Throws as take_place().
  void commit();

 private:
  enum class Stage { pending, stands_where_nothing_was, stands_for_another, kept };

  std::error_code create_parents();
  void create_temporary();
  void discard() noexcept;

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  /// Parents that did not exist, outermost first.
  std::vector<std::filesystem::path> created_parents_;
  Kind kind_;
  bool overwrite_;
  Stage stage_ = Stage::pending;
};

/// Outputs that appear together when all are complete, or not at all.
class PendingOutputs {
 public:
  /// Files that may already exist under an output's name without `overwrite`.
  enum class Existing { nothing, same, anything };

  /// `inputs` are files and folders that were read and must not change. With `together`, commit()
  /// passes the outputs on to that object, whose commit() makes them appear.
  explicit PendingOutputs(bool overwrite, std::vector<std::filesystem::path> inputs = {},
                          PendingOutputs* together = nullptr);
  PendingOutputs(const PendingOutputs&) = delete;
  PendingOutputs& operator=(const PendingOutputs&) = delete;
  ~PendingOutputs();

  /// Adds an output and returns its temporary path. Throws OutputError as PendingOutput does.
  ///
  /// `same` is for a companion of the main output, which must be added first. An existing companion
  /// with other content is replaced only together with an existing main output, and only if it does
  /// not belong to `owner` as well. One with the same content may be left from a killed run.
  /// `anything` is for a file that describes an output and appears after it.
  const std::filesystem::path& add(const std::filesystem::path& target, PendingOutput::Kind kind,
                                   Existing existing = Existing::nothing,
                                   const std::filesystem::path& owner = {});

  /// Marks a file of an earlier output that could be mistaken for a part of this one; commit()
  /// removes it. Throws OutputError if `same` would not replace it.
  void add_stale(const std::filesystem::path& path, const std::filesystem::path& owner = {});

  /// Makes all outputs appear, the first added one after the others, and then the files that
  /// describe outputs. Whoever sees the main output therefore sees its companions. Contents are on
  /// the disk before names change, and names when this returns. Other runs that commit in the same
  /// folders wait. Throws OutputError, and then nothing has changed.
  void commit();

 private:
  struct Entry {
    std::unique_ptr<PendingOutput> output;
    /// Error unless an existing file has the same content; empty for no check.
    std::string unless_same;
    bool tells_of_another;
  };

  std::string reason_to_keep(const std::filesystem::path& owner) const;
  void hand_over();
  void drop_repeated();
  void check() const;
  void check_same() const;
  void check_inputs_stay() const;
  std::vector<PendingOutput*> in_order() const;
  void swap(const std::vector<PendingOutput*>& order);

  bool overwrite_;
  std::vector<std::filesystem::path> inputs_;
  PendingOutputs* together_;
  std::vector<Entry> entries_;
  std::vector<std::filesystem::path> stale_;
};

/// Removes the temporary files of this process, and empty folders made for them, after running
/// commits have finished. Call it only before the process ends, since later commits block forever.
void remove_pending_outputs() noexcept;

/// Throws OutputError if writing `output` would replace one of `inputs`, contain it, or change a
/// part of it. Compares files and folders, not paths.
void check_inputs_stay(const std::filesystem::path& output,
                       const std::vector<std::filesystem::path>& inputs);

/// Reason not to replace a companion of the output `main` by other content: it belongs to `owner`
/// as well, `main` does not exist, or `overwrite` is false. Empty if it may be replaced.
std::string why_to_keep(const std::filesystem::path& main, const std::filesystem::path& owner,
                        bool overwrite);

/// Files that may already exist under the name of a file beside an output. A run's manifest
/// (NAME.run.json, mimetra-run.json) may replace anything, and its caller must choose a suitable
/// name. Other files are companions.
PendingOutputs::Existing existing_beside(std::string_view name);

/// Writes `content` to `target` through PendingOutputs. Throws OutputError.
void write_file(const std::filesystem::path& target, std::string_view content, bool overwrite,
                PendingOutputs* together = nullptr);

}  // namespace mimetra
