"""The system calls that remain: a list of what Python, numpy and matplotlib need, compiled by libseccomp.

What is not listed is answered with ENOSYS, as by a kernel that does not have it, so that the C library falls back to
what is listed; what programs try by the way and can do without is refused with EPERM. Nothing here opens a socket,
starts a program, mounts, traces, looks into another process, or loads code into the kernel.
"""

# ruff: noqa: SIM905  (a hundred words are easier to read than a hundred strings)
from __future__ import annotations

import errno
import tempfile

from dhlib.errors import DHError

ADVICE = "libseccomp is missing: install it (Debian and Ubuntu: apt install libseccomp2) and pip install pyseccomp."

ALLOWED = """
read readv pread64 preadv preadv2 write writev pwrite64 pwritev pwritev2 close close_range lseek
open openat openat2 creat stat fstat lstat newfstatat statx statfs fstatfs access faccessat faccessat2 readlink
readlinkat getdents getdents64 getcwd chdir fchdir mkdir mkdirat rmdir unlink unlinkat rename renameat renameat2
link linkat symlink symlinkat truncate ftruncate fallocate fsync fdatasync utimensat utime utimes futimesat umask
chmod fchmod fchmodat copy_file_range sendfile fadvise64 flock dup dup2 dup3 pipe pipe2
mmap munmap mremap mprotect madvise brk msync mincore
rt_sigaction rt_sigprocmask rt_sigreturn rt_sigpending rt_sigsuspend rt_sigtimedwait sigaltstack restart_syscall
kill tkill tgkill pause alarm getitimer setitimer signalfd4 eventfd2
timer_create timer_settime timer_gettime timer_getoverrun timer_delete timerfd_create timerfd_settime timerfd_gettime
nanosleep clock_nanosleep clock_gettime clock_getres gettimeofday time times getrusage sysinfo
fork vfork wait4 waitid exit exit_group set_tid_address set_robust_list get_robust_list futex futex_waitv rseq
membarrier sched_yield sched_getaffinity sched_getparam sched_getscheduler arch_prctl getcpu
getpid getppid gettid getpgid getpgrp getsid setpgid getuid geteuid getgid getegid getgroups getresuid getresgid
getpriority getrlimit setrlimit prlimit64 uname getrandom capget
poll ppoll select pselect6 epoll_create epoll_create1 epoll_ctl epoll_wait epoll_pwait epoll_pwait2
socketpair sendmsg recvmsg sendto recvfrom shutdown getsockopt getsockname
""".split()

#: Refused as to somebody without the right to, since programs that ask are ready for it.
REFUSED = """
socket connect bind listen accept accept4 setsockopt execve execveat ptrace process_vm_readv process_vm_writev
kcmp pidfd_getfd mount umount2 pivot_root chroot setns unshare swapon swapoff reboot bpf perf_event_open
keyctl add_key request_key userfaultfd memfd_create shmget shmat shmctl semget semop msgget mq_open
setuid setgid setreuid setregid setresuid setresgid setgroups setfsuid setfsgid capset chown fchown lchown fchownat
mknod mknodat personality sched_setaffinity sched_setscheduler setpriority setsid mlock mlock2 mlockall
sethostname setdomainname settimeofday clock_settime adjtimex init_module finit_module delete_module kexec_load
syslog quotactl acct ioperm iopl name_to_handle_at open_by_handle_at fanotify_init inotify_init inotify_init1
setxattr lsetxattr fsetxattr
""".split()

#: What else ``ioctl`` may be asked: is this a terminal, how many bytes wait, do not block, close on exec, and not.
IOCTLS = (0x5401, 0x5413, 0x541B, 0x5421, 0x5450, 0x5451)
#: What ``prctl`` may be asked: names of threads, and to name memory.
PRCTLS = (15, 16, 0x53564D41)
#: Bits of the flags of ``clone`` that ask for new namespaces: mount, cgroup, UTS, IPC, user, PID, network.
NAMESPACES = 0x7E020000


def compile_filter() -> bytes:
    """The filter, as the kernel takes it.

    Raises
    ------
    DHError
        If libseccomp is not there.
    """
    try:
        import pyseccomp as seccomp  # type: ignore[import-untyped, unused-ignore]
    except (ImportError, RuntimeError, OSError):
        raise DHError(ADVICE) from None

    filter_ = seccomp.SyscallFilter(seccomp.ERRNO(errno.ENOSYS))
    filter_.set_attr(seccomp.Attr.CTL_OPTIMIZE, 2)  # a tree: hundreds of rules cost no more than ten
    refuse = seccomp.ERRNO(errno.EPERM)

    def rule(action: int, call: str, *arguments: object) -> None:
        try:
            filter_.add_rule(action, call, *arguments)
        except (OSError, ValueError):  # a call that this processor does not have
            if call in ("read", "openat"):
                raise

    for call in ALLOWED:
        rule(seccomp.ALLOW, call)
    for call in REFUSED:
        rule(refuse, call)
    rule(seccomp.ALLOW, "clone", seccomp.Arg(0, seccomp.MASKED_EQ, NAMESPACES, 0))
    for request in IOCTLS:
        rule(seccomp.ALLOW, "ioctl", seccomp.Arg(1, seccomp.MASKED_EQ, 0xFFFFFFFF, request))
    for request in PRCTLS:
        rule(seccomp.ALLOW, "prctl", seccomp.Arg(0, seccomp.EQ, request))
    rule(seccomp.ALLOW, "fcntl")
    with tempfile.TemporaryFile() as file:
        filter_.export_bpf(file)
        file.seek(0)
        return file.read()
