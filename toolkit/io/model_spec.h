#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace mimetra {

/// A model directory or file, and the identity asked for: `MODEL@identity003=1.5,identity007=-1`,
/// or `MODEL@NAME.fit.json` with fitted coefficients.
struct ModelSpec {
  std::filesystem::path path;
  std::vector<std::pair<std::string, double>> identity;
  /// Everything after '@', as given; for naming outputs.
  std::string identity_text;
  /// Coefficients that were fitted.
  std::optional<std::filesystem::path> fit = {};

  /// The '@' counts after the last '/' (where a .json follows: the first one that follows something
  /// that exists), and only where nothing has the whole text as its name.
  /// Throws std::invalid_argument for what is not NAME=NUMBER after it, a name given twice, and
  /// where there is no path.
  static ModelSpec parse(const std::string& text);
  /// `ict-face@identity007=2`, without folders; a file without its extension; `sfm@target` for
  /// `sfm@out/target.fit.json`.
  std::string name() const;
  /// What is to be said of coefficients that nobody means.
  std::vector<std::string> notes() const;
};

}  // namespace mimetra
