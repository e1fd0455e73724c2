#pragma once

#include <string>
#include <vector>

namespace mimetra {

/// The known word nearest to `word` by edit distance, capital or not, where it is near enough to be
/// meant; empty otherwise. Ties go to the earlier word.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

/// "; did you mean 'WORD'?" with that one, to end a message; empty where there is none.
std::string suggestion_for(const std::string& word, const std::vector<std::string>& known);

}  // namespace mimetra
