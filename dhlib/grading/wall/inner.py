"""The second wall: what stands between one submission and the next, and between a submission and its server.

A process that calls `enter` gives up, for itself and all it will start, every other process, the network, every file
but its own 32 MiB and what can only be read, all rights, and most system calls. Runs in the forked child of the
server, so it uses the kernel directly and imports nothing but the standard library.
"""

from __future__ import annotations

import ctypes
import os
import resource
import struct
from collections.abc import Mapping
from typing import Any

CLONE_NEWNS, CLONE_NEWCGROUP, CLONE_NEWUTS, CLONE_NEWIPC = 0x00020000, 0x02000000, 0x04000000, 0x08000000
CLONE_NEWUSER, CLONE_NEWPID, CLONE_NEWNET = 0x10000000, 0x20000000, 0x40000000
ALL_SPACES = (
    CLONE_NEWUSER | CLONE_NEWPID | CLONE_NEWNET | CLONE_NEWNS | CLONE_NEWIPC | CLONE_NEWUTS | CLONE_NEWCGROUP
)  # fmt: skip
MS_RDONLY, MS_NOSUID, MS_NODEV, MS_NOEXEC, MS_REC, MS_PRIVATE = 1, 2, 4, 8, 0x4000, 1 << 18
PR_SET_PDEATHSIG, PR_SET_DUMPABLE, PR_SET_SECCOMP, PR_CAPBSET_DROP = 1, 4, 22, 24
PR_SET_NO_NEW_PRIVS, PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL = 38, 47, 4
SECCOMP_MODE_FILTER = 2
LAST_CAPABILITY = 40
NOBODY = 65534
#: The one folder that a submission may write to.
HOME = "/tmp"
#: Address space that Python with its libraries maps without using it.
MAPPED = 3 << 30

LANDLOCK_CREATE_RULESET, LANDLOCK_ADD_RULE, LANDLOCK_RESTRICT_SELF = 444, 445, 446
LANDLOCK_READ = 0b1100  # read a file, list a folder
LANDLOCK_ALL_BY_ABI = {1: 0x1FFF, 2: 0x3FFF, 3: 0x7FFF}
LANDLOCK_EXECUTE, LANDLOCK_DEVICES = 1, (1 << 6) | (1 << 11)

_libc = ctypes.CDLL(None, use_errno=True)


class Program(ctypes.Structure):
    """A filter of system calls, as the kernel takes it."""

    _fields_ = [("length", ctypes.c_ushort), ("code", ctypes.c_char_p)]


def _check(result: int, doing: str) -> None:
    if result < 0:
        number = ctypes.get_errno()
        raise OSError(number, f"{doing}: {os.strerror(number)}")


def prctl(option: int, *arguments: Any) -> int:
    """Call prctl(2); raises OSError."""
    given = [a if isinstance(a, ctypes._SimpleCData) else ctypes.c_ulong(a) for a in arguments]
    result: int = _libc.prctl(option, *given, *[ctypes.c_ulong(0)] * (4 - len(given)))
    _check(result, f"prctl {option}")
    return result


def become(user: int) -> None:
    """Be this user from now on, without any other right; 0 changes nothing."""
    if user:
        os.setgroups([])
        os.setresgid(user, user, user)
        os.setresuid(user, user, user)
        prctl(PR_SET_DUMPABLE, 1)  # else its files in /proc, which namespaces are set up through, would be root's


def own_spaces() -> None:
    """Go into namespaces of its own; the next child is the first process of its own world."""
    user, group = os.geteuid(), os.getegid()
    _check(_libc.unshare(ALL_SPACES), "namespaces")
    for name, content in (
        ("setgroups", "deny"),
        ("uid_map", f"{NOBODY} {user} 1"),
        ("gid_map", f"{NOBODY} {group} 1"),
    ):
        fd = os.open(f"/proc/self/{name}", os.O_WRONLY)
        os.write(fd, content.encode())
        os.close(fd)


def own_root() -> None:
    """From root of a container become root of a namespace, which may build walls and has nobody beside it.

    Nobody has to be there for `become`: the kernel holds no process of the machine's own root to a limit of processes.
    """
    me = os.getpid()
    told, tell = os.pipe()
    helper = os.fork()
    if helper == 0:  # stays outside, where it may still say who is who inside
        try:
            os.close(tell)
            os.read(told, 1)
            for name in ("uid_map", "gid_map"):
                fd = os.open(f"/proc/{me}/{name}", os.O_WRONLY)
                os.write(fd, f"0 0 1\n{NOBODY} {NOBODY} 1\n".encode())
                os.close(fd)
            os._exit(0)
        finally:
            os._exit(1)
    try:
        _check(_libc.unshare(CLONE_NEWUSER), "user namespace")
    finally:
        os.close(told)
        os.close(tell)
        status = os.waitpid(helper, 0)[1]
    if status:
        raise OSError("user namespace: root and nobody cannot be mapped")


def own_files(disk_bytes: int) -> None:
    """See no processes and no files of others, and have one small folder in memory."""
    _mount("none", "/", None, MS_REC | MS_PRIVATE)
    _mount("tmpfs", "/proc", "tmpfs", MS_RDONLY | MS_NOSUID | MS_NODEV | MS_NOEXEC, "size=4k,nr_inodes=1")
    _mount("tmpfs", HOME, "tmpfs", MS_NOSUID | MS_NODEV | MS_NOEXEC, f"size={disk_bytes},nr_inodes=4096,mode=700")
    os.chdir(HOME)


def _mount(source: str, target: str, kind: str | None, flags: int, options: str = "") -> None:
    result = _libc.mount(
        source.encode(), target.encode(), kind.encode() if kind else None, ctypes.c_ulong(flags), options.encode()
    )
    _check(result, f"mount {target}")


def bound(limits: Mapping[str, Any]) -> None:
    """Bound time, memory, processes and files."""
    memory, seconds = int(limits["memory"]), int(limits["notebook_seconds"]) + 2
    for name, most in (
        (resource.RLIMIT_AS, memory + MAPPED),
        (resource.RLIMIT_DATA, memory + int(limits["base"])),
        (resource.RLIMIT_CPU, seconds),
        (resource.RLIMIT_FSIZE, int(limits["disk_bytes"])),
        (resource.RLIMIT_NOFILE, 256),
        (resource.RLIMIT_NPROC, int(limits["processes"]) + int(limits["others"])),
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_MEMLOCK, 0),
        (resource.RLIMIT_MSGQUEUE, 0),
        (resource.RLIMIT_SIGPENDING, 256),
    ):
        hard = resource.getrlimit(name)[1]
        if hard != resource.RLIM_INFINITY:
            most = min(most, hard)
        resource.setrlimit(name, (most, most))


def bounded() -> bool:
    """Whether the kernel holds this process to a limit of processes: it holds none of the machine's own root.

    Ends its use for anything else, since the limit stays.
    """
    resource.setrlimit(resource.RLIMIT_NPROC, (1, 1))
    try:
        if os.fork() == 0:
            os._exit(0)
    except OSError:
        return True
    os.wait()
    return False


def drop_rights() -> None:
    """Give up all capabilities, for good."""
    for capability in range(LAST_CAPABILITY + 1):
        try:
            prctl(PR_CAPBSET_DROP, capability)
        except OSError:  # an older kernel knows fewer
            break
    prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL)
    header = struct.pack("Ii", 0x20080522, 0)
    _check(_libc.capset(header, bytes(24)), "capabilities")
    prctl(PR_SET_NO_NEW_PRIVS, 1)
    prctl(PR_SET_DUMPABLE, 0)


def landlock_version() -> int:
    """The version of Landlock in the kernel; 0 if it has none."""
    return max(0, int(_libc.syscall(LANDLOCK_CREATE_RULESET, None, ctypes.c_size_t(0), 1)))


def landlock(disk: str = HOME) -> bool:
    """Where the kernel has Landlock: read only, but for one folder. False where it has none or refuses."""
    version = landlock_version()
    if not version:
        return False
    everything = LANDLOCK_ALL_BY_ABI[min(version, max(LANDLOCK_ALL_BY_ABI))]
    attributes = struct.pack("Q", everything)
    rules = _libc.syscall(LANDLOCK_CREATE_RULESET, attributes, ctypes.c_size_t(len(attributes)), 0)
    if rules < 0:
        return False
    try:
        for path, rights in (("/", LANDLOCK_READ), (disk, everything & ~LANDLOCK_EXECUTE & ~LANDLOCK_DEVICES)):
            fd = os.open(path, os.O_PATH | os.O_CLOEXEC)
            added = _libc.syscall(LANDLOCK_ADD_RULE, rules, 1, struct.pack("<Qi", rights, fd), 0)
            os.close(fd)
            if added < 0:
                return False
        return int(_libc.syscall(LANDLOCK_RESTRICT_SELF, rules, 0)) == 0
    finally:
        os.close(rules)


def filter_calls(code: bytes) -> None:
    """Leave only the system calls that a filter allows."""
    program = Program(len(code) // 8, code)
    prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, ctypes.c_void_p(ctypes.addressof(program)))


def die_with_parent() -> None:
    """End when the process that started this one ends."""
    prctl(PR_SET_PDEATHSIG, 9)
