#pragma once

/// How what a filter was asked for ended: what failed has been said, an abort needs no words.
enum class Attempt { done, aborted, failed };
