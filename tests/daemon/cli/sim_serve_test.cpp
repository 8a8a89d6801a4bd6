// `gonio sim serve` as it is shipped, to a client that knows USB/IP from its description alone.

#include <signal.h>
#include <sys/stat.h>

#include "driver/protocol/chunk.h"
#include "driver/protocol/reports.h"
#include "tests/daemon/cli/documents.h"
#include "tests/support/usbip_frame.h"
#include "tests/support/wait_until.h"

namespace gonio::test {
namespace {

using Json = nlohmann::json;
using Bytes = UsbipClient::Bytes;

/// Serving, until it is told to end.
class Serving {
public:
    Serving(const Program& program, std::vector<std::string> arguments) : program_(program) {
        arguments.insert(arguments.begin(),
                         {GONIO_PROGRAM,
                          "--store",
                          (program / "store").string(),
                          "--json",
                          "sim",
                          "serve",
                          "--usbip",
                          "--port",
                          "0"});
        child_ = spawnProcess(arguments, program / "serve.out", program / "serve.err");
        EXPECT_TRUE(waitUntil([&] {
            document_ = Json::parse(textOf(program_ / "serve.out"), nullptr, false);
            return !document_.is_discarded();
        })) << textOf(program_ / "serve.err");
    }
    ~Serving() { (void)end(SIGKILL); }
    Serving(const Serving&) = delete;
    Serving& operator=(const Serving&) = delete;

    [[nodiscard]] const Json& document() const { return document_; }
    [[nodiscard]] int port() const { return document_.value("port", 0); }
    int end(int signal) {
        if (child_ <= 0) return -1;
        ::kill(child_, signal);
        int status = 0;
        waitpid(child_, &status, 0);
        child_ = 0;
        return exitCodeOf(status);
    }

private:
    const Program& program_;
    pid_t child_ = 0;
    Json document_;
};

class SimServe : public testing::Test {
protected:
    /// What it says of a command line that it must refuse with this exit code.
    std::string refused(int code, std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {"sim", "serve"});
        const Ran ran = gonio(std::move(arguments));
        EXPECT_EQ(ran.exitCode, code) << ran.err;
        EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
        return ran.err;
    }
    Program gonio;
};

TEST_F(SimServe, AClientEnumeratesReadsDescriptorsAndStreamsAFrame) {
    Serving serving(gonio, {"--serial", "LAB-2", "--serial", "LAB-1", "--place", "black"});
    EXPECT_EQ(complaintsOf(serving.document()), "") << serving.document();
    const Json& rigs = serving.document()["rigs"];
    ASSERT_EQ(rigs.size(), 2U);
    EXPECT_EQ(rigs[0]["serial"], "LAB-1");
    EXPECT_EQ(rigs[0]["how"],
              "usbip --tcp-port " + std::to_string(serving.port()) + " attach -r 127.0.0.1 -b 1-1");

    const UsbipClient list(serving.port());
    list.list();
    EXPECT_EQ(UsbipClient::word(list.receive(12), 8), 2U);

    UsbipClient client(serving.port());
    ASSERT_EQ(client.import("1-2"), 0U);
    EXPECT_EQ(client.get(0x80, 6, 0x0100, 0, 18).data.size(), 18U);
    const auto serial = client.get(0x80, 6, 0x0303, 0x0409, 255).data;
    std::string text;
    for (std::size_t i = 2; i < serial.size(); i += 2) text += static_cast<char>(serial[i]);
    EXPECT_EQ(text, "LAB-2");

    beginDarkFrame(client, {64, 48});
    std::size_t pixels = 0;
    for (int chunk = 0; chunk < 3; ++chunk) {
        client.submit(true, 2, 257 * 1024);
        const auto ended = client.next(true);
        const auto decoded = driver::decodeChunk(ended.data);
        ASSERT_TRUE(decoded) << decoded.error().message;
        if (decoded->header.type == driver::ChunkType::Data) pixels += decoded->header.length;
    }
    EXPECT_EQ(pixels, 2U * 64 * 48);
    EXPECT_EQ(serving.end(SIGTERM), 0) << textOf(gonio / "serve.err");
}

TEST_F(SimServe, CtrlCEndsItWithAClientAttached) {
    Serving serving(gonio, {});
    UsbipClient client(serving.port());
    ASSERT_EQ(client.import("1-1"), 0U);
    client.submit(true, 2, 257 * 1024);
    EXPECT_EQ(serving.end(SIGINT), 0);
    EXPECT_EQ(client.receive(48).size(), 0U);
}

TEST_F(SimServe, AFaultScriptPullsTheCable) {
    writeText(gonio / "faults", "at 0.2s unplug\n");
    Serving serving(gonio, {"--faults", gonio / "faults"});
    EXPECT_TRUE(waitUntil([&] { return UsbipClient(serving.port()).import("1-1") == 4U; }));
}

TEST_F(SimServe, SaysAllRigsThoughTheScriptPullsThemAtOnce) {
    writeText(gonio / "faults", "at 0s unplug\n");
    Serving serving(gonio,
                    {"--serial", "LAB-2", "--serial", "LAB-1", "--faults", gonio / "faults"});
    const Json& rigs = serving.document()["rigs"];
    ASSERT_EQ(rigs.size(), 2U);
    EXPECT_EQ(rigs[0]["serial"], "LAB-1");
    EXPECT_EQ(rigs[1]["serial"], "LAB-2");
    EXPECT_EQ(rigs[1]["bus_id"], "1-2");
    EXPECT_TRUE(waitUntil([&] { return UsbipClient(serving.port()).import("1-2") == 4U; }));
}

TEST_F(SimServe, SaysWhatIsWrongAndTheCure) {
    EXPECT_NE(refused(2, {}).find("--usbip"), std::string::npos);
    EXPECT_NE(refused(2, {"--usbip", "--attach"}).find("--attach"), std::string::npos);
    EXPECT_NE(refused(2, {"--usbip", "--bind", "localhost"}).find("127.0.0.1"), std::string::npos);
    EXPECT_NE(refused(2, {"--usbip", "--port", "70000"}).find("65535"), std::string::npos);
    EXPECT_NE(refused(2, {"--usbip", "--serial", "A", "--serial", "A"}).find("twice"),
              std::string::npos);
    EXPECT_NE(refused(2, {"--usbip", "--serial", ""}).find("printable"), std::string::npos);
    EXPECT_NE(refused(2, {"--usbip", "--serial", "x y"}).find("blanks"), std::string::npos);
    EXPECT_NE(refused(2, {"--usbip", "--camera", "usb1"}).find("camera"), std::string::npos);
    writeText(gonio / "bad", "at noon unplug\n");
    EXPECT_NE(refused(6, {"--usbip", "--faults", gonio / "bad"}).find("line 1"), std::string::npos);
    Serving serving(gonio, {});
    EXPECT_NE(refused(4, {"--usbip", "--port", std::to_string(serving.port())}).find("--port"),
              std::string::npos);
}

TEST_F(SimServe, WithoutTheKernelsModuleItSaysHowToLoadIt) {
    if (std::filesystem::exists("/sys/devices/platform/vhci_hcd.0")) {
        GTEST_SKIP() << "the module is loaded";
    }
    EXPECT_NE(refused(3, {"--attach"}).find("modprobe vhci-hcd"), std::string::npos);
}

}  // namespace
}  // namespace gonio::test
