"""Zip files that come out the same each time."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Collection, Mapping

#: The date of every file: the same content gives the same zip.
MOMENT = (2026, 1, 1, 0, 0, 0)


def packed(files: Mapping[str, bytes], executable: Collection[str] = ()) -> bytes:
    """A zip of some files, in the order of their names.

    Parameters
    ----------
    files : mapping of str to bytes
    executable : collection of str
        Names of those that may be run.
    """
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, MOMENT)
            entry.create_system = 3  # Unix: else the bits below mean nothing
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if name in executable else 0o100644) << 16
            archive.writestr(entry, files[name])
    return buffer.getvalue()
