"""What a power cut leaves of a disk, worked out from the calls that were made until then.

Names live in folders and bytes in files, and each reaches the disk when it is synced itself: fsync of a file makes its bytes last, fsync of a
folder the names in it, syncfs all. What was not synced may be there, or not. Three disks are made of each moment:

empty    all names as they were last; files hold what they held when they were synced last, or nothing (a file system that writes names first)
zeros    the same, and as long as they were, with zeros where nothing was synced
names    folders hold the names that they held when they were synced last, too (a file system that writes nothing unasked);
         what was removed stays away

The folder itself is changed, so that all that is left of it keeps its inode, by which programs may know it.
"""
import os
import shutil
from pathlib import Path

LOSSES = ("empty", "zeros", "names")
EXCHANGE = 2  # the flag of renameat2
O_TMPFILE = 0o20000000
ITSELF = "/proc/self/fd/"


class File:
    def __init__(self, data=b""):
        self.data, self.synced = bytearray(data), bytes(data)

    def sync(self):
        self.synced = bytes(self.data)

    def left(self, loss):
        rest = len(self.data) - len(self.synced)
        return self.synced + (b"\0" * max(0, rest) if loss == "zeros" else b"")


class Link:
    def __init__(self, target):
        self.target = target

    def sync(self):
        pass


class Folder:
    def __init__(self):
        self.names, self.synced = {}, {}

    def sync(self):
        self.synced = dict(self.names)


class Disk:
    """The folder `place` as it is now, all of it synced, and then what calls make of it."""

    def __init__(self, place):
        self.place = Path(place)
        self.root = self._scanned(self.place)
        self.open = {}  # by process and descriptor

    def _scanned(self, place):
        folder = Folder()
        for entry in sorted(place.iterdir()):
            if entry.is_symlink():
                folder.names[entry.name] = Link(os.readlink(entry))
            else:
                folder.names[entry.name] = self._scanned(entry) if entry.is_dir() else File(entry.read_bytes())
        folder.sync()
        return folder

    def _parent(self, path):
        """The folder in which a path stands, and its name there; none outside of the disk."""
        parts = Path(path).relative_to(self.place).parts
        folder = self.root
        for part in parts[:-1]:
            folder = folder.names[part]
        return folder, parts[-1] if parts else None

    def _at(self, path):
        folder, name = self._parent(path)
        return folder if name is None else folder.names.get(name)

    def sync_all(self, node=None):
        node = node or self.root
        node.sync()
        for below in node.names.values() if isinstance(node, Folder) else ():
            self.sync_all(below) if isinstance(below, Folder) else below.sync()

    def make(self, call):
        """Follows one call of the log."""
        action = getattr(self, "_" + call.name, None)
        if action and call.result >= 0:
            action(call)

    def _open(self, call):
        if call.flags & O_TMPFILE:
            self.open[call.process, call.result] = (File(), call.flags)
            return
        folder, name = self._parent(call.path)
        if name is not None and call.flags & os.O_CREAT and name not in folder.names:
            folder.names[name] = File()
        node = self._at(call.path)
        if call.flags & os.O_TRUNC and call.flags & (os.O_WRONLY | os.O_RDWR):
            node.data.clear()
        self.open[call.process, call.result] = (node, call.flags)

    def _close(self, call):
        self.open.pop((call.process, call.fd), None)

    def _write(self, call):
        node, flags = self.open[call.process, call.fd]
        at = len(node.data) if flags & os.O_APPEND else call.offset
        node.data.extend(b"\0" * (at - len(node.data)))
        node.data[at:at + len(call.bytes)] = call.bytes

    def _ftruncate(self, call):
        node, _ = self.open[call.process, call.fd]
        del node.data[call.offset:]
        node.data.extend(b"\0" * (call.offset - len(node.data)))

    def _fsync(self, call):
        node, _ = self.open.get((call.process, call.fd), (self._at(call.path), 0))  # a folder that opendir opened
        node.sync()

    _fdatasync = _fsync

    def _syncfs(self, call):
        self.sync_all()

    def _mkdir(self, call):
        folder, name = self._parent(call.path)
        folder.names[name] = Folder()

    def _unlink(self, call):
        folder, name = self._parent(call.path)
        del folder.names[name]

    _rmdir = _remove = _unlink

    def _rename(self, call):
        (folder, name), (to, new) = self._parent(call.path), self._parent(call.second)
        if call.flags & EXCHANGE:
            folder.names[name], to.names[new] = to.names[new], folder.names[name]
        else:
            to.names[new] = folder.names.pop(name)

    def _link(self, call):
        folder, name = self._parent(call.second)
        by_number = call.path.startswith(ITSELF)  # a file that had no name
        folder.names[name] = self.open[call.process, int(call.path[len(ITSELF):])][0] if by_number else self._at(call.path)

    def _symlink(self, call):
        folder, name = self._parent(call.path)
        folder.names[name] = Link("")

    def lose(self, loss):
        """Takes away from the real folder what a power cut would take now."""
        self._require_same(self.root, self.place)
        if loss == "names":
            stash = self.place.with_name(self.place.name + ".stash")
            stash.mkdir()
            self._take_away(self.root, self.place, stash)
            self._put_back(self.root, self.place, stash)
            shutil.rmtree(stash)
        self._cut(self.root, self.place, loss)

    def _require_same(self, folder, place):
        there = {entry.name for entry in place.iterdir()}
        assert there == set(folder.names), f"{place} holds {sorted(there)}, and by the calls {sorted(folder.names)}: calls escape the layer"
        for name, node in folder.names.items():
            if isinstance(node, Folder):
                self._require_same(node, place / name)

    def _take_away(self, folder, place, stash):
        for name, node in folder.names.items():
            if isinstance(node, Folder):
                self._take_away(node, place / name, stash)
            if folder.synced.get(name) is not node:
                (place / name).rename(stash / str(id(node)))

    def _put_back(self, folder, place, stash):
        for name, node in folder.synced.items():
            if folder.names.get(name) is not node and (stash / str(id(node))).exists():
                (stash / str(id(node))).rename(place / name)
        folder.names = {name: node for name, node in folder.synced.items() if (place / name).exists()}
        for name, node in folder.names.items():
            if isinstance(node, Folder):
                self._put_back(node, place / name, stash)

    def _cut(self, folder, place, loss):
        for name, node in folder.names.items():
            if isinstance(node, Folder):
                self._cut(node, place / name, loss)
            elif isinstance(node, File) and node.data != node.synced:
                with open(place / name, "r+b") as file:
                    file.write(node.left(loss))
                    file.truncate()
