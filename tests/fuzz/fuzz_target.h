#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// Readers that libFuzzer feeds with damaged files.
namespace mimetra::fuzz {

namespace fs = std::filesystem;

struct Target {
  std::string name;
  /// What the reader finds the bytes under. What seeds write beside it stays there.
  std::string file;
  /// Reads it. It may throw what readers promise: std::invalid_argument, IoError.
  std::function<void(const fs::path& file)> read;
  /// Each writes a sound file, to start from; one at least.
  std::vector<std::function<void(const fs::path& file)>> seeds;
};

/// A seed that is a text.
std::function<void(const fs::path& file)> text(std::string content);

/// Every format of files in the table of formats that can be read: a new one needs nothing here.
std::vector<Target> format_targets();
/// What else is read: models, weights, landmarks, compressed parts of files.
std::vector<Target> model_targets();
/// Whatever is said in a text of its own: options, manifests, names.
std::vector<Target> text_targets();
/// The C interface, whose calls and arrays are made of the bytes.
std::vector<Target> interface_targets();

}  // namespace mimetra::fuzz
