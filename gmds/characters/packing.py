"""Tables of numbers and bytes packed into a GLB file (glTF 2.0, sec. 3.6 and 4)."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

_COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}  # componentType, by dtype
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
_ARRAY, _ELEMENTS = 34962, 34963  # targets of views: attributes of vertices, and indices (sec. 5.11.5)


class Packer:
    """The buffer of a GLB file while it is being filled; `views` and `accessors` describe what is in it."""

    def __init__(self) -> None:
        self.content = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, content: bytes, **about: Any) -> int:
        """The number of a new view of these bytes."""
        self.content += b"\0" * (-len(self.content) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.content), "byteLength": len(content), **about})
        self.content += content
        return len(self.views) - 1

    def table(self, values: NDArray[Any], *, target: int | None = None, bounds: bool = False, **about: Any) -> int:
        """The number of a new accessor of a table (count, k), of little-endian numbers of glTF's types."""
        table = np.ascontiguousarray(values)
        kind = f"{table.dtype.kind}{table.dtype.itemsize}"
        view = self.view(table.astype(f"<{kind}").tobytes(), **({} if target is None else {"target": target}))
        accessor = {"bufferView": view, "componentType": _COMPONENTS[kind], "count": len(table), **about}
        accessor["type"] = _TYPES[table.shape[1]]
        if bounds and len(table):
            accessor |= {"min": table.min(axis=0).tolist(), "max": table.max(axis=0).tolist()}
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def attribute(self, values: NDArray[Any], *, bounds: bool = False, normalized: bool = False) -> int:
        """An accessor of values on vertices: rows of a multiple of four bytes."""
        about = {"normalized": True} if normalized else {}
        return self.table(values, target=_ARRAY, bounds=bounds, **about)

    def indices(self, faces: NDArray[np.int64]) -> int:
        """An accessor of the corners of triangles (m, 3)."""
        kind = np.uint16 if faces.max(initial=0) < 65535 else np.uint32  # the largest number has another meaning
        return self.table(faces.reshape(-1, 1).astype(kind), target=_ELEMENTS)

    def glb(self, tree: dict[str, Any]) -> bytes:
        """The file: a description that lacks what is packed here, and the buffer."""
        self.content += b"\0" * (-len(self.content) % 4)
        whole = {**tree, "buffers": [{"byteLength": len(self.content)}]}
        whole |= {"bufferViews": self.views, "accessors": self.accessors}
        text = json.dumps(whole, separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode("utf-8")
        text += b" " * (-len(text) % 4)
        head = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self.content))
        described = struct.pack("<I4s", len(text), b"JSON") + text
        return head + described + struct.pack("<I4s", len(self.content), b"BIN\0") + bytes(self.content)
