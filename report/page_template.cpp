#include "downwash/report/page_template.hpp"

#ifdef DOWNWASH_RUN_PAGE
#include "downwash/base/embedded_file.hpp"

DOWNWASH_EMBED_FILE(downwash_run_page, DOWNWASH_RUN_PAGE);
#endif

namespace downwash {

std::string_view run_page_template() noexcept {
#ifdef DOWNWASH_RUN_PAGE
    return DOWNWASH_EMBEDDED_FILE(downwash_run_page);
#else
    return {};
#endif
}

}  // namespace downwash
