#include "toolkit/mesh/note.h"

namespace mimetra {

OptionError::OptionError(Topic topic, const std::string& text)
    : MismatchError(text), topic_(topic) {}

}  // namespace mimetra
