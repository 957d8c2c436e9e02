#pragma once

#include <cstddef>
#include <string_view>

// Files that become part of the program as they are, for GCC and Clang on ELF platforms.

/// Defines NAME_begin and NAME_end around the bytes of a file. To be used once for a NAME, outside of any namespace, in
/// a source file that the build compiles again when the file changes (OBJECT_DEPENDS).
#define DOWNWASH_EMBED_FILE(NAME, PATH)                        \
    asm(".section .rodata\n"                                   \
        ".global " #NAME "_begin\n.hidden " #NAME              \
        "_begin\n"                                             \
        ".global " #NAME "_end\n.hidden " #NAME "_end\n" #NAME \
        "_begin:\n"                                            \
        ".incbin \"" PATH "\"\n" #NAME                         \
        "_end:\n"                                              \
        ".byte 0\n"                                            \
        ".previous\n");                                        \
    extern "C" const char NAME##_begin[], NAME##_end[]

/// What stands between them.
#define DOWNWASH_EMBEDDED_FILE(NAME) std::string_view(NAME##_begin, static_cast<std::size_t>(NAME##_end - NAME##_begin))
