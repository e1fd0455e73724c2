#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// XML as ParaView's files use it, read without a library: elements with attributes. Declarations
/// are refused, and with them a file's own entities.
namespace mimetra {

struct XmlElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string parent;  ///< name of the element around it, empty for the root
  /// Last text directly inside the element that is not blank, without white space around it.
  std::string_view text = {};
  std::size_t end_of_tag = 0;  ///< position behind the start tag

  /// Value of an attribute, or "" if it is missing.
  std::string attribute(const std::string& key) const;
};

/// All elements in the order of their start tags, up to an AppendedData element, which holds bytes.
/// Elements refer to `text`. Throws IoError, beginning with `path`, for malformed XML, unclosed
/// elements, and more than 32 nested elements.
std::vector<XmlElement> xml_elements(const std::string& path, std::string_view text);

}  // namespace mimetra
