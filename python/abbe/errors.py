"""The exceptions and warnings that Abbe raises."""


class Error(Exception):
    """The base of all exceptions of Abbe; its text is that of the command line.

    `diagnostics` lists all errors and warnings about the inputs, each with `file`, `pointer`, `message` and `severity`. It is empty if the
    error does not concern an input.
    """

    def __init__(self, message, diagnostics=()):
        super().__init__(message)
        self.diagnostics = list(diagnostics)


class UsageError(Error, ValueError):
    """An argument has a value that is not allowed."""


class SceneError(Error, ValueError):
    """The description of a scene is invalid."""


class InputError(Error):
    """An input file or a named table is missing or corrupt."""


class OutputError(Error):
    """An output cannot be written."""


class ResourceError(Error, MemoryError):
    """The operation needs more memory than is available or allowed."""


class InternalError(Error):
    """A bug in Abbe."""


class SceneWarning(UserWarning):
    """A warning about valid input that probably does not give the intended result."""


def _diagnostic(*state):
    """Restores a diagnostic from another process."""
    from ._abbe import Diagnostic

    return Diagnostic._of(state)
