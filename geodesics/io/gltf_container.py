"""The parts of a glTF file: its description, a JSON tree, and its buffers of bytes; GLB or .gltf with all inside."""

from __future__ import annotations

import base64
import binascii
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geodesics.errors import BadContainer, ExternalReference, TruncatedFile

_DRACO = "KHR_draco_mesh_compression"
_MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")
_UNPACK = "save it without compression (gltf-transform copy in.glb out.glb, or the exporter's switch)"


@dataclass(frozen=True)
class Gltf:
    """A glTF file: description, buffers, and how many bytes lie behind what it declares."""

    tree: dict[str, Any]
    buffers: list[bytes]
    path: Path
    longer: int = 0

    def item(self, kind: str, index: Any) -> dict[str, Any]:
        """The description of accessor, mesh, node ... number `index`."""
        items = self.tree.get(kind, [])
        if type(index) is not int or not 0 <= index < len(items):
            raise BadContainer(f"{self.path}: {kind} {index!r} is referred to, and there are {len(items)}")
        if not isinstance(items[index], dict):
            raise TypeError(f"{kind} {index} is no object")
        return dict(items[index])

    def bytes_of_view(self, index: Any, what: str) -> tuple[bytes, int]:
        """The bytes of a view, and its stride (0 where it has none)."""
        view = self.item("bufferViews", index)
        for name in _MESHOPT:
            if name in view.get("extensions", {}) and self.item("buffers", view["buffer"]).get("uri") is None:
                fallback = self.item("buffers", view["buffer"]).get("extensions", {}).get(name, {}).get("fallback")
                if fallback or not self.buffers[view["buffer"]]:
                    raise BadContainer(f"{self.path}: the mesh is compressed by meshopt ({name}); {_UNPACK}")
        start, length = view.get("byteOffset", 0), view["byteLength"]
        if min(start, length) < 0:
            raise BadContainer(f"{self.path}: {what} has a negative length or place")
        number = view.get("buffer", 0)
        held = self.buffers[number] if type(number) is int and 0 <= number < len(self.buffers) else b""
        if start + length > len(held):
            needed = f"needs {length} bytes from byte {start}, and its part of the file has {len(held)}"
            raise BadContainer(f"{self.path}: {what} {needed}")
        return held[start : start + length], int(view.get("byteStride", 0))

    def refuse_draco(self, primitive: dict[str, Any]) -> None:
        """`BadContainer` for a piece whose numbers are only there in compressed form."""
        if _DRACO not in primitive.get("extensions", {}):
            return
        used = [primitive["attributes"].get("POSITION"), primitive.get("indices")]
        if any("bufferView" not in self.item("accessors", index) for index in used if index is not None):
            raise BadContainer(f"{self.path}: the mesh is compressed by Draco ({_DRACO}); {_UNPACK}")


def open_gltf(data: bytes, path: Path) -> Gltf:
    """A GLB or glTF file whose declared lengths are those that are there."""
    if data.startswith(b"glTF"):
        text, binary, longer = _chunks(data, path)
    else:
        text, binary, longer = data.removeprefix(b"\xef\xbb\xbf"), b"", 0
    try:
        tree = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise BadContainer(f"{path}: the JSON part is malformed ({error})") from error
    if not isinstance(tree, dict) or not (data.startswith(b"glTF") or "asset" in tree):
        raise BadContainer(f"{path}: the JSON part is malformed: it does not describe a glTF asset")
    buffers = [_buffer(item, binary, number, path) for number, item in enumerate(tree.get("buffers", []))]
    return Gltf(tree, buffers, path, longer)


def _buffer(item: dict[str, Any], binary: bytes, number: int, path: Path) -> bytes:
    uri = item.get("uri")
    if uri is None:
        return binary if number == 0 else b""
    if not (isinstance(uri, str) and uri.startswith("data:")):
        raise ExternalReference(f"{path}: data in other files is not opened; export one self-contained GLB")
    try:
        return base64.b64decode(uri.partition(",")[2], validate=True)
    except (binascii.Error, ValueError) as error:
        raise TruncatedFile(f"{path}: the data inside buffer {number} are cut off or damaged ({error})") from error


def _chunks(data: bytes, path: Path) -> tuple[bytes, bytes, int]:
    """JSON, binary, and how many bytes come behind: every declared length against the bytes that are there."""
    declared = int.from_bytes(data[8:12], "little")
    if len(data) < 20 or not 20 <= declared <= len(data):
        raise TruncatedFile(f"{path}: the GLB header declares a length of {declared}, and {len(data)} bytes are found")
    if int.from_bytes(data[4:8], "little") != 2:
        raise BadContainer(f"{path}: only version 2 of glTF is supported")
    chunks, at = [], 12
    while at < declared:
        size = int.from_bytes(data[at : at + 4], "little")
        if at + 8 + size > declared:
            raise TruncatedFile(f"{path}, byte {at}: a chunk of {size} bytes passes the end of the file")
        chunks.append((data[at + 4 : at + 8], data[at + 8 : at + 8 + size]))
        at += 8 + size
    binary = next((chunk for kind, chunk in chunks[1:] if kind == b"BIN\0"), b"")
    return chunks[0][1], binary, len(data) - declared
