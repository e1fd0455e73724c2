#pragma once

#include <filesystem>

#include <gtest/gtest.h>

#include "tests/test_folders.h"

/// Skips the running test where `path` is not there.
#define MIMETRA_SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << (path) << " is not there"
