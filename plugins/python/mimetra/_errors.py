"""Errors with the library's messages, one class for each status code of mimetra.h."""


class Error(Exception):
    """The computation failed. `status` is the command's exit code in the same case."""

    status = 1


class UsageError(Error, ValueError):
    """The request is wrong whatever the data."""

    status = 2


class BadInput(Error, ValueError):
    """An input is wrong in itself."""

    status = 3


class Mismatch(Error, ValueError):
    """Inputs contradict each other or the request."""

    status = 4


class OutputError(Error):
    """An output cannot be written, or exists."""

    status = 5


class Cancelled(Error):
    """The progress function said so."""

    status = 130


def error_of(status, message):
    """Exception for a status other than 0."""
    classes = (UsageError, BadInput, Mismatch, OutputError, Cancelled)
    return next((each for each in classes if each.status == status), Error)(message)
