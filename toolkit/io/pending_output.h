#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "toolkit/io/binary_file.h"

namespace mimetra {

/// A file or folder that appears under its name only when it is whole.
///
/// What is written goes to `path()`, a temporary name in the same folder, which takes the place of
/// what stands under the name in one step. A process that dies before leaves nothing under the name
/// asked for, and a destroyed object that was not committed removes what it wrote.
class PendingOutput {
 public:
  using Kind = OutputKind;

  /// Creates missing parent folders, and the temporary file or folder itself. Throws OutputError
  /// where `target` exists and not `overwrite`, nothing can be written there, or a folder to
  /// overwrite holds anything that its manifest does not list (written_files.h).
  PendingOutput(const std::filesystem::path& target, Kind kind, bool overwrite);
  ~PendingOutput();
  PendingOutput(const PendingOutput&) = delete;
  PendingOutput& operator=(const PendingOutput&) = delete;

  /// A hidden name without the target's extension: a writer that chooses its format by extension
  /// needs it from elsewhere.
  const std::filesystem::path& path() const { return temporary_; }
  const std::filesystem::path& target() const { return target_; }
  Kind kind() const { return kind_; }
  /// Throws OutputError where `target` is, or meanwhile became, one that the constructor refuses.
  void check_target() const;

  /// Makes it whole: a folder gets a manifest that lists its files. Throws OutputError.
  void complete();
  /// Stands under its name from now on, what stood there under the temporary one, whose permissions
  /// it takes. Throws as check_target(), and then nothing has changed. \pre complete()
  void take_place();
  /// Undoes take_place(), where that was done.
  void give_place_back() noexcept;
  /// After take_place(): keeps the place, and removes what stood there.
  void keep_place() noexcept;
  /// All of these. Throws as take_place().
  void commit();

 private:
  enum class Stage { pending, stands_where_nothing_was, stands_for_another, kept };

  std::error_code create_parents();
  void create_temporary();
  void discard() noexcept;

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  /// Parents that were missing, outermost first.
  std::vector<std::filesystem::path> created_parents_;
  Kind kind_;
  bool overwrite_;
  Stage stage_ = Stage::pending;
};

/// Outputs that appear together when all of them are whole, or not at all.
class PendingOutputs {
 public:
  /// What may stand already under an output's name where nothing may be overwritten.
  enum class Existing { nothing, same, anything };

  /// `inputs` are files and folders that were read and must stay. With `together`, commit() leaves
  /// what was added to that one, whose commit() makes it appear.
  explicit PendingOutputs(bool overwrite, std::vector<std::filesystem::path> inputs = {},
                          PendingOutputs* together = nullptr);
  PendingOutputs(const PendingOutputs&) = delete;
  PendingOutputs& operator=(const PendingOutputs&) = delete;
  ~PendingOutputs();

  /// The temporary path to write to. Throws OutputError as PendingOutput does. `same` is for a file
  /// that goes with the main output, which was added first: where one stands with another content,
  /// it is replaced only as a part of a main output that is, and not where it is a part of `owner`
  /// too; a killed run may have left one of the same content. `anything` is for one that tells of
  /// an output and comes after it.
  const std::filesystem::path& add(const std::filesystem::path& target, PendingOutput::Kind kind,
                                   Existing existing = Existing::nothing,
                                   const std::filesystem::path& owner = {});

  /// A file of an earlier output that would be taken for a part of this one. Throws OutputError
  /// where `same` would not replace it; commit() removes it.
  void add_stale(const std::filesystem::path& path, const std::filesystem::path& owner = {});

  /// What was added first comes last, but for what tells of it: whoever sees it sees all that
  /// belongs to it. Contents are on the disk before names change, names when this returns. Other
  /// runs that commit in the same folders wait. Throws OutputError, and then everything is as it
  /// was.
  void commit();

 private:
  struct Entry {
    std::unique_ptr<PendingOutput> output;
    std::string unless_same;  ///< why it must hold what stands there; empty where it need not
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

/// Removes what outputs of this process have written under temporary names, and empty folders made
/// for them, once outputs that are taking their places have done so. For a process that is about to
/// end: none can be committed afterwards.
void remove_pending_outputs() noexcept;

/// Throws OutputError if writing `output` would replace one of `inputs`, or become a part of it: it
/// is that file or folder, by whatever path, holds it, is something that exists in it, or a new
/// file in it.
void check_inputs_stay(const std::filesystem::path& output,
                       const std::vector<std::filesystem::path>& inputs);

/// Why a file that stands where one would go with the output `main` is not to be replaced by
/// another content: it is a part of `owner` too, or stands without `main`, or nothing may be
/// overwritten. Empty where it may be.
std::string why_to_keep(const std::filesystem::path& main, const std::filesystem::path& owner,
                        bool overwrite);

/// What may stand already under the name of a file that a run writes beside its output: a run's
/// manifest (NAME.run.json, mimetra-run.json) tells of it and may replace anything, which who names
/// it sees to; others go with it.
PendingOutputs::Existing existing_beside(std::string_view name);

/// Writes `content` to `target` by way of PendingOutputs. Throws OutputError.
void write_file(const std::filesystem::path& target, std::string_view content, bool overwrite,
                PendingOutputs* together = nullptr);

}  // namespace mimetra
