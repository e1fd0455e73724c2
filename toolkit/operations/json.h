#pragma once

/// What an operation reports is JSON.
#include "toolkit/io/json_text.h"
