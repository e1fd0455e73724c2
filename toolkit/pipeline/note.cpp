#include "toolkit/pipeline/note.h"

namespace mimetra {

void note(const Notes& notes, std::string text, Topic topic) {
  if (notes) notes({topic, std::move(text)});
}

OptionError::OptionError(Topic topic, const std::string& text)
    : MismatchError(text), topic_(topic) {}

}  // namespace mimetra
