#pragma once

/// Outcome of an attempt. A failure has been shown to the user; an abort needs no message.
enum class Attempt { done, aborted, failed };
