"""The log of the layer (journal.hpp), and the ways in which each call can fail."""
from dataclasses import dataclass

ROOM = {"write", "mkdir", "rename", "link", "symlink"}  # and open with O_CREAT
REMOVAL = {"unlink", "rmdir", "remove", "opendir", "readdir"}  # what removes, and what finds that which is to be removed
LOSING = {"kill"}  # after these nothing could be tidied up
O_CREAT = 0o100

WAYS = {
    "open": ("EIO", "EACCES", "EMFILE", "EINTR"),
    "read": ("EIO", "EINTR", "short"),
    "write": ("ENOSPC", "EIO", "EDQUOT", "EINTR", "short"),
    "close": ("EIO", "EINTR", "ENOSPC"),
    "fsync": ("EIO", "ENOSPC", "EINTR"),
    "fdatasync": ("EIO", "ENOSPC", "EINTR"),
    "syncfs": ("EIO", "ENOSPC"),
    "ftruncate": ("EIO", "EINTR"),
    "mkdir": ("ENOSPC", "EIO", "EACCES", "EDQUOT"),
    "rename": ("ENOSPC", "EIO", "EACCES"),
    "link": ("ENOSPC", "EIO", "EPERM"),
    "symlink": ("ENOSPC", "EIO", "EPERM"),
    "flock": ("EINTR", "ENOLCK"),
    "fcntl": ("EIO", "ENOLCK"),
    "mmap": ("ENOMEM",),
}
OTHERS = ("EIO", "EACCES")  # unlink, stat, opendir, ...
ON_DESCRIPTORS = ("EIO",)  # fstat, readdir, fchmod: their right was asked for before


@dataclass
class Call:
    number: int
    process: int
    name: str
    result: int
    error: int
    failed: bool  # was made to
    fd: int
    offset: int
    flags: int
    path: str
    second: str
    bytes: bytes
    callers: tuple

    @property
    def needs_room(self):
        return self.name in ROOM or (self.name == "open" and self.flags & O_CREAT != 0)

    def ways(self):
        """The names of failures (FAULTS_HOW) that can befall it."""
        one = WAYS.get(self.name, ON_DESCRIPTORS if self.fd >= 0 else OTHERS)
        if self.name == "open" and self.needs_room:
            one += ("ENOSPC", "EDQUOT")
        return one + ("kill", "EIO...") + (("ENOSPC...",) if self.needs_room else ())


def read_log(file):
    calls = []
    for line in file.read_text().splitlines() if file.exists() else ():
        words = line.split("\t")
        result, error, failed, fd, offset, flags = (int(word) for word in words[3:9])
        calls.append(Call(int(words[0]), int(words[1]), words[2], result, error, failed == 1, fd, offset, flags, words[9], words[10],
                          bytes.fromhex(words[11]), tuple(words[12].split())))
    return sorted(calls, key=lambda call: call.number)
