#pragma once

#include <string>

namespace mimetra {

/// `text` as XML and HTML hold it, between tags and in attributes.
std::string escaped_for_xml(const std::string& text);

}  // namespace mimetra
