"""Text files that people write, read whole: a study, a record, a list."""

import os
import stat

MOST_BYTES = 2**18
"""Size of the largest file that is read, in seconds; the paper's study has 5000."""


def read_text(path, error_type):
    """Read a small text file, without ever waiting for it.

    Parameters
    ----------
    path : str or Path
        The file, UTF-8, with or without a byte order mark.
    error_type : type
        The child of LubeError to raise.

    Returns
    -------
    str
        Its text.

    Raises
    ------
    LubeError
        Of `error_type`, if it cannot be read, is a folder, a pipe or a device, is too large, or
        is no UTF-8 text.
    """
    try:
        content = _content(path)
    except UnicodeDecodeError:
        reason = "it is not UTF-8 text"
    except OSError as error:
        reason = error.strerror or str(error)
    except ValueError:
        reason = "no file has such a name"
    else:
        if content is not None:
            return content
        reason = f"need a file of {MOST_BYTES} bytes at most, no folder, pipe or device"
    raise error_type(f"{path}: cannot be read: {reason}")


def _content(path):
    """Text of a file, or None if it is not one that people write."""
    # To open a pipe may take forever.
    if not stat.S_ISREG(os.stat(path).st_mode):
        return None
    with open(path, "rb") as file:
        content = file.read(MOST_BYTES + 1)
    return content.decode("utf-8-sig") if len(content) <= MOST_BYTES else None
