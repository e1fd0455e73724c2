#pragma once

#include <string>
#include <string_view>

namespace mimetra {

std::string base64(std::string_view bytes);

}  // namespace mimetra
