#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// The text form of USD, as far as a layer that stands for itself needs it, and what its properties
/// hold. Internal to the format.
///
/// [Pixar. OpenUSD: Usda File Format]
namespace mimetra {

/// A value: numbers of lists and tuples one after the other, or words (strings, tokens, paths).
struct UsdValue {
  std::vector<double> numbers = {};
  std::vector<std::string> words = {};
};

/// An attribute or a relationship.
struct UsdProperty {
  int line = 0;
  UsdValue value = {};
  bool has_value = false;
  std::vector<std::pair<double, UsdValue>> samples = {};  ///< by time code, which rises
  int blocked_line = 0;                                   ///< of a sample that is None
  std::string type = {};                                  ///< "rel" for a relationship
  std::string interpolation = {};
};

struct UsdPrim {
  std::string specifier;  ///< def, over or class
  std::string type, name;
  int line = 0;
  std::map<std::string, UsdValue> metadata = {};
  std::map<std::string, UsdProperty> properties = {};
  std::vector<UsdPrim> children = {};
};

struct UsdLayer {
  std::map<std::string, UsdValue> metadata;
  std::vector<UsdPrim> prims;
};

/// Reads the text of a layer. Throws IoError that names the line, also for what would bring in
/// other layers or leave a choice: references, payloads, sublayers, variants and the like.
UsdLayer parse_usd(const std::string& path, std::string_view text);

/// Throws IoError with path and line.
[[noreturn]] void usd_fail(const std::string& path, int line, const std::string& message);

/// Null where the prim has none of that name.
const UsdProperty* usd_property(const UsdPrim& prim, const std::string& name);

/// The numbers of a property at a time: the nearest sample's outside of them, and a straight line
/// between two of them. Its own value where it has no samples, or where no time is asked for.
/// Throws IoError with the line where one is not finite, or a sample is None.
std::vector<double> usd_numbers(const std::string& path, const UsdProperty& property,
                                std::optional<double> code = {});

/// Throws IoError with the line of a property of which a number is not finite, or a time sample is
/// None.
void check_numbers(const std::string& path, const UsdProperty& property,
                   const std::vector<double>& numbers);

/// The same as counts and indices. Throws IoError with the line where one is none.
std::vector<int> usd_integers(const std::string& path, const UsdProperty& property,
                              const std::string& name);

/// A property that the prim must have. Throws IoError.
const UsdProperty& usd_needed(const std::string& path, const UsdPrim& prim,
                              const std::string& name);

/// Whether the first word of a property is `word`.
bool usd_is_word(const UsdPrim& prim, const std::string& name, const std::string& word);

}  // namespace mimetra
