#pragma once

#include <string>

#include "plugins/c/mimetra.h"
#include "plugins/c/whole_struct.h"
#include "toolkit/operations/parameter.h"

/// What the descriptions of plugins are made of. All throw UsageError that says what is wrong.
namespace mimetra {

/// Names are typed as commands and options: small letters, digits and '-'.
std::string name_of(const char* name, const std::string& what);

/// One line of text; empty for none.
std::string line_of(const char* text, const std::string& what);

Parameter parameter_of(const mimetra_parameter& described);

/// Throws where a name is an option of every command.
void check_not_taken(const std::string& name);

/// Calls `visit` with each struct of a list that ends with NULL.
template <typename Struct, typename Visit>
void for_each(const Struct* const* list, Visit visit) {
  for (; list && *list; ++list) visit(whole(**list));
}

}  // namespace mimetra
