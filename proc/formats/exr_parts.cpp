#include "proc/formats/exr_parts.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <thread>

#include "proc/core/parallel.h"
#include "proc/formats/exr_header_walk.h"
#include "proc/formats/shown.h"

namespace gonio::proc {
namespace {

Error failed(const std::string& what) { return {ErrorKind::File, "exr: " + what}; }

class MemoryOut : public Imf::OStream {
public:
    MemoryOut() : Imf::OStream("memory") {}
    void write(const char c[], int n) override {
        const std::size_t end = at_ + static_cast<std::size_t>(n);
        if (bytes_.size() < end) bytes_.resize(end);
        std::memcpy(bytes_.data() + at_, c, static_cast<std::size_t>(n));
        at_ = end;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = static_cast<std::size_t>(at); }
    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
    std::size_t at_ = 0;
};

class MemoryIn : public Imf::IStream {
public:
    explicit MemoryIn(std::string_view bytes) : Imf::IStream("memory"), bytes_(bytes) {}
    bool read(char c[], int n) override {
        if (n < 0 || at_ > bytes_.size() || static_cast<std::size_t>(n) > bytes_.size() - at_) {
            throw std::runtime_error("the file ends early");
        }
        std::memcpy(c, bytes_.data() + at_, static_cast<std::size_t>(n));
        at_ += static_cast<std::size_t>(n);
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t at) override { at_ = static_cast<std::size_t>(at); }

private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

/// The library's pool, started once.
int poolThreads() {
    static const int threads = [] {
        const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
        Imf::setGlobalThreadCount(cores);
        return cores;
    }();
    return threads;
}

/// 0, on the caller's own thread, for what takes a few milliseconds either way: most files, and
/// those of tests that read many.
int decodingThreads(std::size_t fileBytes) {
    constexpr std::size_t kWorthThreads = std::size_t{1} << 20U;
    return fileBytes < kWorthThreads ? 0 : poolThreads();
}

/// All parts of a file must share one display window: it holds the largest of them.
Imath::Box2i displayWindow(std::span<const ExrPart> parts) {
    Imath::V2i last(0, 0);
    for (const ExrPart& part : parts) {
        last.x = std::max(last.x, part.size.width - 1);
        last.y = std::max(last.y, part.size.height - 1);
    }
    return {Imath::V2i(0, 0), last};
}

Imf::Header headerOf(const ExrPart& part, const Imath::Box2i& display) {
    Imf::Header header(part.size.width, part.size.height);
    header.displayWindow() = display;
    header.setName(part.name);
    header.setType(Imf::SCANLINEIMAGE);
    header.compression() = part.packed ? Imf::ZIP_COMPRESSION : Imf::NO_COMPRESSION;
    header.zipCompressionLevel() = 1;  // noise hardly gets smaller with more work
    for (const auto& [key, value] : part.text) header.insert(key, Imf::StringAttribute(value));
    for (const auto& [key, value] : part.numbers) {
        header.insert(key, Imf::FloatVectorAttribute(value));
    }
    for (const auto& channel : part.floats) {
        const Imf::PixelType type = part.half ? Imf::HALF : Imf::FLOAT;
        header.channels().insert(channel.first, Imf::Channel(type));
    }
    for (const auto& channel : part.counts) {
        header.channels().insert(channel.first, Imf::Channel(Imf::UINT));
    }
    return header;
}

/// The library's view of one channel. It takes a mutable address for reading and writing alike.
template <class T>
Imf::Slice sliceOf(Imf::PixelType type, const T* pixels, Size size) {
    char* base = const_cast<char*>(reinterpret_cast<const char*>(pixels));  // NOLINT
    return {type, base, sizeof(T), sizeof(T) * static_cast<std::size_t>(size.width)};
}

Imf::FrameBuffer bufferOf(const ExrPart& part) {
    Imf::FrameBuffer buffer;
    for (const auto& [name, pixels] : part.floats) {
        buffer.insert(name, sliceOf(Imf::FLOAT, pixels.data(), part.size));
    }
    for (const auto& [name, pixels] : part.counts) {
        buffer.insert(name, sliceOf(Imf::UINT, pixels.data(), part.size));
    }
    return buffer;
}

/// The floats of a part as halves, and the library's view of them: it converts on reading only.
struct Halves {
    std::vector<std::vector<half>> channels;
    Imf::FrameBuffer buffer;

    explicit Halves(const ExrPart& part) {
        for (const auto& [name, pixels] : part.floats) {
            channels.emplace_back(pixels.begin(), pixels.end());
            buffer.insert(name, sliceOf(Imf::HALF, channels.back().data(), part.size));
        }
        for (const auto& [name, pixels] : part.counts) {
            buffer.insert(name, sliceOf(Imf::UINT, pixels.data(), part.size));
        }
    }
};

void writePart(Imf::OutputPart& out, const ExrPart& part) {
    if (part.half) {
        const Halves halves(part);
        out.setFrameBuffer(halves.buffer);
        out.writePixels(part.size.height);
    } else {
        out.setFrameBuffer(bufferOf(part));
        out.writePixels(part.size.height);
    }
}

std::string encodeAlone(const ExrPart& part, const Imath::Box2i& display, int threads) {
    const Imf::Header header = headerOf(part, display);
    MemoryOut out;
    {
        Imf::MultiPartOutputFile file(out, &header, 1, false, threads);
        Imf::OutputPart only(file, 0);
        writePart(only, part);
    }
    return out.take();
}

/// Each part packed as a file of its own, all at once: the library's threads share only the few
/// chunks of one part. The first failure is thrown.
std::vector<std::string> encodeEach(std::span<const ExrPart> parts, const Imath::Box2i& display) {
    std::vector<std::string> files(parts.size());
    std::vector<std::exception_ptr> thrown(parts.size());
    parallelFor(parts.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            try {
                files[i] = encodeAlone(parts[i], display, 0);
            } catch (...) {
                thrown[i] = std::current_exception();
            }
        }
    });
    for (const std::exception_ptr& each : thrown) {
        if (each) std::rethrow_exception(each);
    }
    return files;
}

std::string encode(std::span<const ExrPart> parts) {
    const Imath::Box2i display = displayWindow(parts);
    if (parts.size() == 1) return encodeAlone(parts.front(), display, poolThreads());
    const std::vector<std::string> files = encodeEach(parts, display);
    std::vector<Imf::Header> headers;
    for (const ExrPart& part : parts) headers.push_back(headerOf(part, display));
    MemoryOut out;
    {
        Imf::MultiPartOutputFile file(
            out, headers.data(), static_cast<int>(headers.size()), false, 0);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            MemoryIn in(files[i]);
            Imf::MultiPartInputFile packed(in, 0, false);
            Imf::InputPart from(packed, 0);
            Imf::OutputPart(file, static_cast<int>(i)).copyPixels(from);  // chunks as they are
        }
    }
    return out.take();
}

void refuseAbove(std::size_t limit, std::size_t bytes) {
    if (bytes <= limit) return;
    throw std::runtime_error(std::to_string(bytes) + " bytes of pixels, at most " +
                             std::to_string(limit) + " are read");
}

/// The pixels of all parts may not be more than deflate packs of measured values, with a wide
/// margin: known before the library or we make room for any. Constant pictures pack better (1032 :
/// 1), and small files may.
std::size_t mostPixelBytes(std::size_t fileBytes) {
    constexpr std::size_t kUsualRatio = 40;
    constexpr std::size_t kSmall = std::size_t{40} << 20U;
    return std::max(kSmall,
                    fileBytes > SIZE_MAX / kUsualRatio ? SIZE_MAX : kUsualRatio * fileBytes);
}

void checkPromise(const Imf::MultiPartInputFile& file,
                  std::size_t fileBytes,
                  const ExrLimits& limits) {
    std::size_t promised = 0;
    for (int i = 0; i < file.parts(); ++i) {
        const Imf::Header& header = file.header(i);
        const Imath::Box2i window = header.dataWindow();
        if (window.min != Imath::V2i(0, 0)) {
            throw std::runtime_error("a picture does not start at 0,0");
        }
        const Size size{window.max.x + 1, window.max.y + 1};
        std::size_t ofPart = 0;
        for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
            ofPart += size.pixels() * sizeof(float);
        }
        refuseAbove(limits.bytesOfAPart, ofPart);
        promised += ofPart;
    }
    refuseAbove(limits.bytes, promised);
    if (promised > mostPixelBytes(fileBytes)) {
        throw std::runtime_error("more pixels than the file can hold");
    }
}

ExrPart emptyPart(const Imf::Header& header) {
    ExrPart part;
    part.name = header.hasName() ? header.name() : "";
    const Imath::Box2i window = header.dataWindow();
    part.size = {window.max.x + 1, window.max.y + 1};
    for (auto it = header.begin(); it != header.end(); ++it) {
        const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
        if (text != nullptr) part.text[it.name()] = text->value();
        const auto* numbers = dynamic_cast<const Imf::FloatVectorAttribute*>(&it.attribute());
        if (numbers != nullptr) part.numbers[it.name()] = numbers->value();
    }
    for (const char* ours : {"name", "type"}) part.text.erase(ours);  // of the container, not texts
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        const Imf::Channel& channel = it.channel();
        if (channel.xSampling != 1 || channel.ySampling != 1) {
            throw std::runtime_error("a channel is not sampled at every pixel");
        }
        if (channel.type == Imf::UINT) {
            part.counts[it.name()].resize(part.size.pixels());
        } else {
            part.floats[it.name()].resize(part.size.pixels());
            part.half = channel.type == Imf::HALF;
        }
    }
    return part;
}

std::vector<ExrPart> decode(std::string_view bytes, const ExrLimits& limits) {
    MemoryIn in(bytes);
    Imf::MultiPartInputFile file(in, decodingThreads(bytes.size()), false);
    checkPromise(file, bytes.size(), limits);
    std::vector<ExrPart> parts;
    for (int i = 0; i < file.parts(); ++i) {
        Imf::InputPart input(file, i);
        ExrPart part = emptyPart(input.header());
        input.setFrameBuffer(bufferOf(part));
        input.readPixels(0, part.size.height - 1);
        parts.push_back(std::move(part));
    }
    return parts;
}

/// The library's messages end in dots and line ends, and name our memory as the file.
std::string reason(const std::exception& thrown) {
    std::string text = thrown.what();
    text.resize(std::min(text.find('\n'), text.size()));
    while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
    return printable(text);
}

}  // namespace

Result<std::string> encodeExr(std::span<const ExrPart> parts) {
    if (parts.empty()) return failed("no parts to write");
    for (const ExrPart& part : parts) {
        const auto wrong = [&](const auto& channel) {
            return channel.second.size() != part.size.pixels();
        };
        if (std::any_of(part.floats.begin(), part.floats.end(), wrong) ||
            std::any_of(part.counts.begin(), part.counts.end(), wrong) || part.size.pixels() == 0) {
            return Error{ErrorKind::Internal,
                         "exr: part " + part.name + ": channels do not have its size"};
        }
    }
    try {
        return encode(parts);
    } catch (const std::exception& thrown) {
        return failed("not written: " + reason(thrown));
    }
}

Result<std::vector<ExrPart>> decodeExr(std::string_view bytes, ExrLimits limits) {
    if (auto walked = walkExrHeaders(bytes, limits); !walked) return walked.error();
    try {
        return decode(bytes, limits);
    } catch (const std::exception& thrown) {
        return failed("damaged: " + reason(thrown));
    }
}

}  // namespace gonio::proc
