#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// XML as ParaView's files use it, read without a library: elements with attributes. Declarations,
/// and with them entities of a file's own, are refused.
namespace mimetra {

struct XmlElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string parent;      ///< name of the element around it, empty for the root
  std::size_t end_of_tag;  ///< where what it holds begins

  /// Empty where there is none.
  std::string attribute(const std::string& key) const;
};

/// All elements in the order of their beginnings, up to an AppendedData, which holds bytes. Throws
/// IoError with `path` for what is no such XML, for elements that are not closed, and for more than
/// 32 inside each other.
std::vector<XmlElement> xml_elements(const std::string& path, std::string_view text);

}  // namespace mimetra
