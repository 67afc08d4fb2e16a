// The system of the program in node, for emscripten's --js-library: node's fs answers the calls of musl. It
// runs in the thread of main(), the only one that opens files. Descriptors are node's, except those of
// folders and duplicates.
const library = {
  $system__deps: ["$ERRNO_CODES"],
  // own: our descriptors, {of} a duplicate, {path, entries} a folder; copies: how many duplicates a
  // descriptor of node has; names: its path.
  $system__postset: `Object.assign(system, {
    fs: require("fs"), own: new Map(), next: 1 << 20, copies: new Map(), names: new Map(),
    never: new Int32Array(new SharedArrayBuffer(4))});`,
  $system: {
    /** A path of the program for node. The C++ library takes a path with a drive for a relative one, and puts
     * a folder in front of it. */
    path: (at) => {
      const path = UTF8ToString(at);
      return process.platform === "win32" ? path.replace(/^.*[/](?=[A-Za-z]:([/]|$))/, "") : path;
    },
    /** The program's form of a path of node. */
    seen: (path) => process.platform === "win32" ? path.replace(/\\/g, "/") : path,
    /** The result of a call, or the negative number of its error. */
    result: (call) => {
      try {
        return call() || 0;
      } catch (error) {
        if (error.code === undefined) throw error;
        return -(ERRNO_CODES[error.code] || ERRNO_CODES.EIO);
      }
    },
    fail: (code) => { throw Object.assign(new Error(code), {code}); },
    add: (what) => {
      system.own.set(system.next, what);
      return system.next++;
    },
    runs: (process_id) => {
      try {
        return process.kill(process_id, 0);
      } catch (error) {
        return error.code === "EPERM";
      }
    },
    real: (fd) => system.own.has(fd) ? system.own.get(fd).of : fd,
    is_terminal: (fd) => require("tty").isatty(system.real(fd)),
    duplicate: (fd) => {
      const of = system.real(fd);
      system.fs.fstatSync(of);
      system.copies.set(of, (system.copies.get(of) || 0) + 1);
      return system.add({of});
    },
    close: (fd) => {
      const own = system.own.get(fd), of = system.real(fd), left = system.copies.get(of) || 0;
      system.own.delete(fd);
      if (own && own.entries) return;
      if (left > 0) system.copies.set(of, left - 1);
      else system.fs.closeSync(of);
    },
    /** Reads or writes each piece of memory of a list, until one is not used whole. */
    pieces: (list, count, sum, transfer) => {
      let total = 0;
      for (let i = 0; i < count; ++i) {
        const at = {{{ makeGetValue('list', 'i * 8', 'i32') }}};
        const size = {{{ makeGetValue('list', 'i * 8 + 4', 'i32') }}};
        const moved = size > 0 ? system.patiently(() => transfer(HEAPU8.subarray(at, at + size))) : 0;
        total += moved;
        if (moved < size) break;
      }
      {{{ makeSetValue('sum', 0, 'total', 'i32') }}};
    },
    /** Standard streams may be set not to block. */
    patiently: (call) => {
      for (;;) {
        try {
          return call();
        } catch (error) {
          if (error.code === "EOF") return 0;
          if (error.code !== "EAGAIN") throw error;
          Atomics.wait(system.never, 0, 0, 5);
        }
      }
    },
    stat: (stat, out) => {
      {{{ makeSetValue('out', C_STRUCTS.stat.st_dev, 'stat.dev', 'i32') }}};
      {{{ makeSetValue('out', C_STRUCTS.stat.st_mode, 'stat.mode', 'i32') }}};
      {{{ makeSetValue('out', C_STRUCTS.stat.st_nlink, 'stat.nlink', 'i32') }}};
      {{{ makeSetValue('out', C_STRUCTS.stat.st_size, 'stat.size', 'i64') }}};
      {{{ makeSetValue('out', C_STRUCTS.stat.st_ino, 'stat.ino', 'i64') }}};
    },
    flags: (flags) => {
      const c = system.fs.constants, accept = [c.O_RDONLY, c.O_WRONLY, c.O_RDWR];
      let out = accept[flags & 3];
      if (flags & {{{ cDefine('O_CREAT') }}}) out |= c.O_CREAT;
      if (flags & {{{ cDefine('O_EXCL') }}}) out |= c.O_EXCL;
      if (flags & {{{ cDefine('O_TRUNC') }}}) out |= c.O_TRUNC;
      if (flags & {{{ cDefine('O_APPEND') }}}) out |= c.O_APPEND;
      if (flags & {{{ cDefine('O_NOFOLLOW') }}}) out |= c.O_NOFOLLOW;
      if (flags & {{{ cDefine('O_NONBLOCK') }}}) out |= c.O_NONBLOCK;
      return out;
    },
  },
  $getEnvStrings: function() {
    return Object.entries(process.env).map(([key, value]) => key + "=" + value);
  },
  $getEnvStrings__deps: [],
};

const calls = {
  __syscall_open: (at, flags, varargs) => {
    const path = system.path(at);
    if (flags & {{{ cDefine('O_DIRECTORY') }}})
      return system.add({path, entries: [".", "..", ...system.fs.readdirSync(path)]});
    const mode = varargs ? {{{ makeGetValue('varargs', 0, 'i32') }}} : 0;
    const fd = system.fs.openSync(path, system.flags(flags), mode);
    system.names.set(fd, path);
    return fd;
  },
  __syscall_stat64: (at, out) => system.stat(system.fs.statSync(system.path(at)), out),
  __syscall_lstat64: (at, out) => system.stat(system.fs.lstatSync(system.path(at)), out),
  __syscall_fstat64: (fd, out) => {
    const own = system.own.get(fd);
    const of = own && own.entries ? system.fs.statSync(own.path) : system.fs.fstatSync(system.real(fd));
    system.stat(of, out);
  },
  __syscall_access: (path, mode) => system.fs.accessSync(system.path(path), mode),
  __syscall_unlink: (at) => {
    const path = system.path(at);
    if (system.fs.lstatSync(path).isDirectory()) system.fail("EISDIR");
    system.fs.unlinkSync(path);
  },
  __syscall_rmdir: (path) => system.fs.rmdirSync(system.path(path)),
  __syscall_mkdir: (path, mode) => system.fs.mkdirSync(system.path(path), mode),
  __syscall_rename: (from, to) => system.fs.renameSync(system.path(from), system.path(to)),
  __syscall_fchmod: (fd, mode) => system.fs.fchmodSync(system.real(fd), mode),
  __syscall_readlink: (path, out, size) => {
    const to = system.seen(system.fs.readlinkSync(system.path(path)));
    const bytes = Buffer.from(to, "utf8").subarray(0, size);
    HEAPU8.set(bytes, out);
    return bytes.length;
  },
  __syscall_getcwd: (out, size) => {
    if (stringToUTF8(system.seen(process.cwd()), out, size) >= size - 1) system.fail("ERANGE");
    return out;
  },
  __syscall_getdents64: (fd, out, size) => {
    const {entries} = system.own.get(fd);
    let filled = 0;
    const each = {{{ C_STRUCTS.dirent.__size__ }}};
    for (; entries.length > 0 && filled + each <= size; filled += each) {
      const at = out + filled;
      HEAPU8.fill(0, at, at + {{{ C_STRUCTS.dirent.d_name }}});
      {{{ makeSetValue('at', C_STRUCTS.dirent.d_ino, '1', 'i32') }}};
      {{{ makeSetValue('at', C_STRUCTS.dirent.d_reclen, C_STRUCTS.dirent.__size__, 'i16') }}};
      stringToUTF8(entries.shift(), at + {{{ C_STRUCTS.dirent.d_name }}}, 256);
    }
    return filled;
  },
  __syscall_fcntl64: (fd, command) => {
    const DUPFD_CLOEXEC = 1030;
    if (command === {{{ cDefine('F_DUPFD') }}} || command === DUPFD_CLOEXEC) return system.duplicate(fd);
    if (!system.own.has(fd)) system.fs.fstatSync(fd);
  },
  fd_fdstat_get: (fd, out) => {
    let type = {{{ cDefine('__WASI_FILETYPE_REGULAR_FILE') }}};
    if (system.is_terminal(fd)) type = {{{ cDefine('__WASI_FILETYPE_CHARACTER_DEVICE') }}};
    {{{ makeSetValue('out', C_STRUCTS.__wasi_fdstat_t.fs_filetype, 'type', 'i8') }}};
  },
  __syscall_ioctl: (fd, command, varargs) => {
    if (command !== {{{ cDefine('TIOCGWINSZ') }}} || !system.is_terminal(fd)) system.fail("ENOTTY");
    const out = {{{ makeGetValue('varargs', 0, 'i32') }}};
    {{{ makeSetValue('out', 2, '+process.env.COLUMNS || 0', 'i16') }}};
  },
  fd_read: (fd, list, count, sum) => {
    const input = fd === 0, flag = _carom_reads_input() >> 2;
    if (input) Atomics.store(HEAP32, flag, 1);
    try {
      const read = (memory) => system.fs.readSync(system.real(fd), memory, 0, memory.length, null);
      return system.pieces(list, count, sum, read);
    } finally {
      if (input) Atomics.store(HEAP32, flag, 0);
    }
  },
  fd_write: (fd, list, count, sum) =>
    system.pieces(list, count, sum, (memory) => system.fs.writeSync(system.real(fd), memory)),
  fd_close: (fd) => system.close(fd),
  fd_seek: () => system.fail("ESPIPE"),
  fd_sync: (fd) => {
    const own = system.own.get(fd);
    if (!own || !own.entries) return system.fs.fsyncSync(system.real(fd));
    if (process.platform === "win32") return;
    const folder = system.fs.openSync(own.path);
    system.fs.fsyncSync(folder);
    system.fs.closeSync(folder);
  },
  // Only films start programs, and without OpenGL there are none.
  posix_spawnp: () => system.fail("ENOSYS"),
  __syscall_pipe: () => system.fail("ENOSYS"),
  __syscall_poll: () => system.fail("ENOSYS"),
  carom_getpid: () => process.pid,
  carom_page_wasm: () => {
    const wasm = system.fs.readFileSync(require("path").join(location.href, "../../carom.wasm"));
    return allocateUTF8(require("zlib").gzipSync(wasm, {level: 9}).toString("base64"));
  },
  /** Node cannot lock files. The name of a temporary file has the number of the process that writes it, and
   * another file that is locked gets it as its text: the lock holds while that process runs. */
  carom_flock: (fd) => {
    const path = system.names.get(system.real(fd)) || "";
    const temporary = /[.]carom[.](\d+)[.]\d+[.]tmp$/.exec(path);
    const holder = Number(temporary ? temporary[1] : system.fs.readFileSync(path, "utf8"));
    if (holder > 0 && holder !== process.pid && system.runs(holder)) system.fail("EAGAIN");
    if (!temporary) system.fs.writeFileSync(path, String(process.pid));
  },
};

// Each becomes a function of the library, in place of emscripten's and its properties. If it throws, its
// result is the number of the error, negative except from the calls of WASI.
for (const name in calls) {
  const [, words, body] = /^\((.*?)\) =>([^]*)$/.exec(String(calls[name]));
  const sign = name.startsWith("fd_") ? "-" : "", made = () => {};
  made.toString = () => `function(${words}) { return ${sign}system.result(() =>${body}); }`;
  Object.assign(library, {
    [name]: made, [name + "__deps"]: ["$system"], [name + "__proxy"]: "", [name + "__postset"]: "",
  });
}
mergeInto(LibraryManager.library, library);
