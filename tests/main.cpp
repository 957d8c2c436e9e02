#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

// A test that asserts nothing fails, as does a run without a test. Catch2 2.13 takes only one `--warn` from its command
// line.
int main(int argc, char* argv[]) {
    Catch::Session session;
    if (const int error = session.applyCommandLine(argc, argv); error != 0) {
        return error;
    }
    session.configData().warnings =
        static_cast<Catch::WarnAbout::What>(Catch::WarnAbout::NoAssertions | Catch::WarnAbout::NoTests);
    return session.run();
}
