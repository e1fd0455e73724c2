"""One context of the library for each thread, with progress, cancelling and logging."""

import atexit
import contextlib
import ctypes
import logging
import re
import signal
import threading
import time
import weakref

from . import _interface as c
from ._errors import Error, error_of

library = c.load()
_logger = logging.getLogger("mimetra")
_contexts = threading.local()
_all_contexts = weakref.WeakSet()
_first = threading.Lock()
_LONGEST_END = 5  # seconds that the interpreter waits for other threads' runs


@c.Log
def _log(level, text, _):
    if getattr(_contexts, "silent", False):
        return
    _logger.log(logging.WARNING if level == c.WARNING else logging.INFO, "%s",
                in_python(text.decode(errors="replace")))


def in_python(message):
    """Message with options spelled as functions take them."""
    def spelled(option):
        return "force" if option[1] == "overwrite" else option[1].replace("-", "_")
    return re.sub("option '([a-z-]+)'", spelled, message)


class Context:
    """Errors, progress and calls of one thread."""

    def __init__(self, log):
        self.handle = ctypes.c_void_p()
        if library.new_context(log, None, ctypes.byref(self.handle)):
            raise Error("the library cannot make its table of operations")
        c.free_with(self, library.free_context, self.handle)
        self.running = threading.RLock()
        self.ending = False
        _all_contexts.add(self)

    def check(self, status):
        """Raises the exception for a status other than 0."""
        if status:
            raise error_of(status, in_python(library.message(self.handle).decode(errors="replace")))

    def operations(self):
        return [each.contents for each in c.listed(library.operations(self.handle))]

    def formats(self):
        return [each.contents for each in c.listed(library.formats(self.handle))]

    @contextlib.contextmanager
    def watched(self, progress=None, threads=None):
        """Calls `progress(share)` while the block runs; False as its answer cancels. An exception
        from `progress` cancels too and is raised at the end, like the user's Ctrl-C."""
        raised = []

        @c.Progress
        def report(share, _):
            if self.ending:
                return 0
            try:
                answer = progress(share) if progress else None
                goes_on = answer is None or bool(answer)
                return int(goes_on and not raised and not self.ending)
            except BaseException as error:
                raised.append(error)
                return 0

        with self.running:
            self.check(library.set_threads(self.handle, threads or 0))
            self.check(library.set_progress(self.handle, report, None))
            try:
                with _interrupts_kept(raised):
                    yield
            except Error:
                if not raised:
                    raise
            finally:
                library.set_progress(self.handle, c.Progress(), None)
        if raised:
            raise raised[0]


@contextlib.contextmanager
def _interrupts_kept(raised):
    """Stores KeyboardInterrupt in a list, because no exception may pass through the library."""
    if (threading.current_thread() is not threading.main_thread()
            or signal.getsignal(signal.SIGINT) is not signal.default_int_handler):
        yield
        return
    signal.signal(signal.SIGINT, lambda *_: raised.append(KeyboardInterrupt()))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@atexit.register
def _end_runs():
    """Cancels the runs of daemon threads, and prevents new ones, because the interpreter would be
    gone when they report. Does not stop a thread that waits in its own `progress`."""
    others = [each for each in list(_all_contexts)
              if each is not getattr(_contexts, "own", None)]
    for each in others:
        each.ending = True
    until = time.monotonic() + _LONGEST_END
    for each in others:
        each.running.acquire(timeout=max(0, until - time.monotonic()))


def context():
    """Context of this thread. The first one logs the plugins that cannot be used."""
    if not hasattr(_contexts, "own"):
        _contexts.silent = _first.locked()
        _first.acquire(blocking=False)
        _contexts.own = Context(_log)
        _contexts.silent = False
    return _contexts.own
