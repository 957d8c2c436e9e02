#pragma once

#include <cstddef>
#include <string_view>

// Embeds files in the program, for GCC and Clang on ELF platforms.

/// Defines NAME_begin and NAME_end around the bytes of a file. Use it once for each NAME, outside of any namespace, in
/// a source file that the build compiles again if the file changes (OBJECT_DEPENDS).
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

/// The bytes between them.
#define DOWNWASH_EMBEDDED_FILE(NAME) std::string_view(NAME##_begin, static_cast<std::size_t>(NAME##_end - NAME##_begin))
