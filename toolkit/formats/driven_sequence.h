#pragma once

#include "toolkit/formats/model_file.h"
#include "toolkit/io/format.h"

namespace mimetra {

/// Opens a model's performance: by the weights of the options, by the spec's fit, or its neutral
/// without either. Throws IoError, and MismatchError if nothing of the model can be driven.
OpenSequence open_driven(const ModelSpec& spec, const ReadOptions& options,
                         const Context& context = {});

}  // namespace mimetra
