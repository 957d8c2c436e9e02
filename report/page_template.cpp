#include "downwash/report/page_template.hpp"

#ifdef DOWNWASH_RUN_PAGE
// The file as it is, between two names.
asm(".section .rodata\n"
    ".global downwash_run_page_begin\n"
    ".hidden downwash_run_page_begin\n"
    ".global downwash_run_page_end\n"
    ".hidden downwash_run_page_end\n"
    "downwash_run_page_begin:\n"
    ".incbin \"" DOWNWASH_RUN_PAGE
    "\"\n"
    "downwash_run_page_end:\n"
    ".byte 0\n"
    ".previous\n");
extern "C" const char downwash_run_page_begin[], downwash_run_page_end[];
#endif

namespace downwash {

std::string_view run_page_template() noexcept {
#ifdef DOWNWASH_RUN_PAGE
    return {downwash_run_page_begin, static_cast<std::size_t>(downwash_run_page_end - downwash_run_page_begin)};
#else
    return {};
#endif
}

}  // namespace downwash
