"""What Abbe raises."""


class Error(Exception):
    """Anything that Abbe refuses; its text is that of the command line.

    `diagnostics` lists every complaint about the inputs, each with `file`, `pointer`, `message` and `severity`; it is empty where the
    trouble has no place in an input.
    """

    def __init__(self, message, diagnostics=()):
        super().__init__(message)
        self.diagnostics = list(diagnostics)


class UsageError(Error, ValueError):
    """An argument has a value that is not allowed."""


class SceneError(Error, ValueError):
    """The description of a scene is invalid."""


class InputError(Error):
    """An input file, or a table of that name, is missing or corrupt."""


class OutputError(Error):
    """An output cannot be written."""


class ResourceError(Error, MemoryError):
    """More memory would be taken than there is, or than is allowed."""


class InternalError(Error):
    """A bug of Abbe's own."""


class SceneWarning(UserWarning):
    """What is used as it is, but hardly gives what was meant."""


def _diagnostic(*state):
    """A diagnostic as it was in another process."""
    from ._abbe import Diagnostic

    return Diagnostic._of(state)
