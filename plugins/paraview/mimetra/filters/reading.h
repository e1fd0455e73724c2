#pragma once

#include "toolkit/operations/operation.h"

/// What the source does: it reads a sequence, with the fields of formats that have some.
mimetra::Operation reading_operation();
