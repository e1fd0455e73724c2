#pragma once

#include <string>
#include <vector>

#include "toolkit/correspondence/markers.h"
#include "toolkit/mesh/context.h"

namespace mimetra {

/// Looks at markers before anything is fitted to them. Notes, under the target's name, markers that
/// do not lie where the others say (doubtful_markers(), Topic::poor_match); `places` say where each
/// was written, such as "m.txt, line 3", or are none. Throws OptionError (Topic::shifted_markers)
/// where they fit much better as vertices one lower or higher; MismatchError, under the target's
/// name, for what check_markers() refuses.
void check_given_markers(const std::vector<Marker>& markers, const std::vector<std::string>& places,
                         const TriMesh& source, const TriMesh& target, const std::string& name,
                         const Context& context);

}  // namespace mimetra
