#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "toolkit/io/fields_read.h"
#include "toolkit/io/held_parts.h"
#include "toolkit/io/sequence_options.h"
#include "toolkit/mesh/context.h"

namespace mimetra {

class Animation;

/// A format of files that hold a sequence, declared once: readers, writers, and every list of
/// formats come from it.
struct SequenceFormat {
  /// "PC2 point cache".
  std::string name;
  /// In lower case, such as ".pc2".
  std::vector<std::string> extensions;
  /// True where faces and rest pose stand in files beside it.
  bool has_companions = false;
  /// What positions are written in, and what they may be written in by option.
  enum class Precision { single, single_or_double, double_or_single };
  Precision precision;
  OpenSequence (*open)(const std::filesystem::path&, const SequenceSource&, const Context&);
  std::unique_ptr<FrameSink> (*begin)(const SequenceHeader&, const std::filesystem::path& target,
                                      const SequenceWriteOptions&, const ExtraFiles&,
                                      const Context&);
  /// What its files and those beside them have a place for: what they have none for is said.
  HeldParts holds = {};
  /// Writes a model and its weights as such; null where only poses are written.
  std::vector<std::filesystem::path> (*write_animation)(const Animation&,
                                                        const std::filesystem::path& target,
                                                        const SequenceWriteOptions&,
                                                        const ExtraFiles&,
                                                        const Context&) = nullptr;
  /// The fields on its mesh; null for a format that has no place for any.
  FieldsRead (*fields)(const std::filesystem::path&, const Connectivity&, const Context&) = nullptr;
};

/// All formats, in the order in which lists have them.
const std::vector<SequenceFormat>& sequence_formats();
/// The format of a path by its extension, in any case; null for one that is none of theirs.
const SequenceFormat* sequence_format(const std::filesystem::path& path);
/// The extensions of all formats.
std::vector<std::string> sequence_extensions();

}  // namespace mimetra
