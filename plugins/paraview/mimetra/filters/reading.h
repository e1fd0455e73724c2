#pragma once

#include "toolkit/operations/operation.h"

/// Operation of the source: reads a sequence, with fields if the format has some.
mimetra::Operation reading_operation();
