#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace mimetra {

/// A file or folder that appears under its name only when it is whole.
///
/// What is written goes to `path()`, a temporary name in the same folder; `commit()` renames it. A
/// process that dies before leaves nothing under the name asked for, and a destroyed object that
/// was not committed removes what it wrote.
class PendingOutput {
 public:
  enum class Kind { file, folder };

  /// Creates missing parent folders, and the temporary file or folder itself. Throws OutputError
  /// where `target` exists and not `overwrite`, nothing can be written there, or a folder to
  /// overwrite holds anything that its manifest does not list (written_files.h).
  PendingOutput(std::filesystem::path target, Kind kind, bool overwrite);
  ~PendingOutput();
  PendingOutput(const PendingOutput&) = delete;
  PendingOutput& operator=(const PendingOutput&) = delete;

  /// A hidden name without the target's extension: a writer that chooses its format by extension
  /// needs it from elsewhere.
  const std::filesystem::path& path() const { return temporary_; }
  const std::filesystem::path& target() const { return target_; }
  /// Throws OutputError where `target` is, or meanwhile became, one that the constructor refuses.
  void check_target() const;
  /// Renames into place, a folder with a manifest that lists its files. Throws as check_target().
  void commit();

 private:
  void create_parents();
  void create_temporary();
  void replace_folder();
  void discard();

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  /// Parents that were missing, outermost first.
  std::vector<std::filesystem::path> created_parents_;
  Kind kind_;
  bool overwrite_;
  bool committed_ = false;
};

/// Several outputs that appear one right after the other when all of them are whole.
class PendingOutputs {
 public:
  /// What may stand already under an output's name where nothing may be overwritten.
  enum class Existing { nothing, same, anything };

  /// `inputs` are files and folders that were read and must stay.
  explicit PendingOutputs(bool overwrite, std::vector<std::filesystem::path> inputs = {});
  PendingOutputs(const PendingOutputs&) = delete;
  PendingOutputs& operator=(const PendingOutputs&) = delete;
  ~PendingOutputs();

  /// The temporary path to write to. Throws OutputError as PendingOutput does. `same` is for a file
  /// that goes with the main output: a killed run may have left one of the same content.
  const std::filesystem::path& add(const std::filesystem::path& target, PendingOutput::Kind kind,
                                   Existing existing = Existing::nothing);

  /// A file of an earlier output that would be taken for a part of this one. Throws OutputError
  /// unless it may be replaced; commit() removes it.
  void add_stale(const std::filesystem::path& path);

  /// What was added first comes last: whoever sees it sees all that belongs to it. Throws
  /// OutputError, before anything is replaced where one of them cannot be.
  void commit();

 private:
  void check_same() const;
  void check_inputs_stay() const;

  bool overwrite_;
  std::vector<std::filesystem::path> inputs_;
  std::vector<std::unique_ptr<PendingOutput>> outputs_;
  std::vector<const PendingOutput*> must_be_same_;
  std::vector<std::filesystem::path> stale_;
};

/// Throws OutputError where writing `output` would replace one of `inputs`: it is that file or
/// folder, holds it, or is a file that exists in it.
void check_inputs_stay(const std::filesystem::path& output,
                       const std::vector<std::filesystem::path>& inputs);

/// Writes `content` to `target` by way of a PendingOutput. Throws OutputError.
void write_file(const std::filesystem::path& target, std::string_view content, bool overwrite);

}  // namespace mimetra
