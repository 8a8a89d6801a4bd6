#include "proc/formats/rgl.h"

#include <gtest/gtest.h>

#include <limits>

#include "proc/formats/little_endian.h"
#include "proc/formats/tensor_file.h"
#include "tests/formats/refusal.h"
#include "tests/support/tensor_tables.h"

namespace gonio::proc {
namespace {

using test::refuses;
using test::smallTensor;

std::string smallFile() {
    const auto written = writeRgl(smallTensor());
    EXPECT_TRUE(written);
    return written->bytes;
}

/// The fields of a file, changed and written again.
template <class Change>
std::string changed(const std::string& bytes, const Change& change) {
    auto fields = parseTensorFile(bytes, "t");
    EXPECT_TRUE(fields);
    change(*fields);
    return writeTensorFile(*fields);
}

TensorField& field(std::vector<TensorField>& fields, std::string_view name) {
    return *std::find_if(
        fields.begin(), fields.end(), [&](const TensorField& f) { return f.name == name; });
}

TEST(TensorFile, HoldsFieldsOfEveryTypeInOrder) {
    const std::string data(48, 'x');
    std::vector<TensorField> fields;
    for (int type = 1; type <= 11; ++type) {
        const auto t = static_cast<TensorType>(type);
        fields.push_back({.name = "field" + std::to_string(type),
                          .type = t,
                          .shape = {2, 3},
                          .data = std::string_view(data).substr(0, 6 * bytesOf(t))});
    }
    fields.push_back({.name = "scalar", .type = TensorType::U8, .shape = {}, .data = "y"});
    fields.push_back({.name = "", .type = TensorType::U8, .shape = {0}, .data = ""});
    const std::string bytes = writeTensorFile(fields);
    const auto back = parseTensorFile(bytes, "t");
    ASSERT_TRUE(back) << back.error().message;
    ASSERT_EQ(back->size(), fields.size());
    for (std::size_t i = 0; i < fields.size(); ++i) {
        EXPECT_EQ((*back)[i].name, fields[i].name);
        EXPECT_EQ((*back)[i].type, fields[i].type);
        EXPECT_EQ((*back)[i].shape, fields[i].shape);
        EXPECT_EQ((*back)[i].data, fields[i].data);
        if (!fields[i].data.empty()) {
            EXPECT_EQ(((*back)[i].data.data() - bytes.data()) % 8, 0);
        }
    }
}

TEST(TensorFile, RefusesFieldsThatTheFileCannotHold) {
    const auto one = [](std::vector<std::uint64_t> shape, std::uint64_t place, std::uint8_t type) {
        std::string bytes("tensor_file\0\1\0", 14);
        appendLittle<std::uint32_t>(bytes, 1);
        appendLittle<std::uint16_t>(bytes, 1);
        bytes += 'a';
        appendLittle(bytes, static_cast<std::uint16_t>(shape.size()));
        appendLittle(bytes, type);
        appendLittle(bytes, place);
        for (const std::uint64_t extent : shape) appendLittle(bytes, extent);
        return bytes + std::string(8, '\0');
    };
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
    EXPECT_TRUE(parseTensorFile(one({8}, 40, 1), "t"));
    EXPECT_TRUE(refuses(parseTensorFile(one({kMost}, 0, 10), "t"), {"rgl: t: field 'a'"}));
    EXPECT_TRUE(refuses(parseTensorFile(one({1ULL << 32, 1ULL << 32}, 0, 1), "t")));
    EXPECT_TRUE(refuses(parseTensorFile(one({2}, kMost, 10), "t")));
    EXPECT_TRUE(refuses(parseTensorFile(one({2}, kMost - 7, 10), "t")));
    EXPECT_TRUE(refuses(parseTensorFile(one({100}, 0, 1), "t"), {"100 values of 1 bytes at 0"}));
    EXPECT_TRUE(refuses(parseTensorFile(one({2}, 0, 0), "t"), {"type 0"}));
    EXPECT_TRUE(refuses(parseTensorFile(one({2}, 0, 12), "t"), {"type 12"}));
    std::string many("tensor_file\0\1\0", 14);
    appendLittle<std::uint32_t>(many, 0xFFFFFFFFU);
    EXPECT_TRUE(refuses(parseTensorFile(many, "t"), {"more fields"}));
}

TEST(TensorFile, RefusesNamesThatAreGivenTwice) {
    const std::vector<TensorField> twice(
        2, {.name = "a", .type = TensorType::U8, .shape = {1}, .data = "x"});
    EXPECT_TRUE(refuses(parseTensorFile(writeTensorFile(twice), "t"), {"'a' is given twice"}));
}

TEST(Rgl, ReadsBackWhatItWrites) {
    const TensorTable table = smallTensor();
    Metadata about;
    about.set("sample", "a tile");
    about.set("notes", "two\nlines");
    about.comments = {"a comment"};
    const auto once = writeRgl(table, about);
    ASSERT_TRUE(once);
    EXPECT_TRUE(once->loss.items.empty());
    const auto back = parseRgl(once->bytes, "t.bsdf");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->about, about);
    EXPECT_EQ(back->content.thetaIn, table.thetaIn);
    EXPECT_EQ(back->content.values.values, table.values.values);
    EXPECT_EQ(back->content.vndf.values, table.vndf.values);
    EXPECT_EQ(back->content.channels, table.channels);
    EXPECT_TRUE(back->warnings.empty());
    const auto twice = writeRgl(back->content, back->about);
    ASSERT_TRUE(twice);
    EXPECT_EQ(twice->bytes, once->bytes);
}

TEST(Rgl, HoldsSpectraByWavelength) {
    TensorTable table = smallTensor();
    table.channels = {{"", 400}, {"", 500}, {"", 600}};
    const auto written = writeRgl(table);
    ASSERT_TRUE(written);
    const auto back = parseRgl(written->bytes, "t.bsdf");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->content.channels, table.channels);
    table.channels = {{"", 400}, {"", 600}, {"", 500}};
    EXPECT_FALSE(writeRgl(table));
    table.channels = {{"X", {}}, {"Y", {}}, {"Z", {}}};
    EXPECT_FALSE(writeRgl(table));
}

TEST(Rgl, WritesOneChannelThrice) {
    TensorTable table = smallTensor();
    table.channels = {{}};
    table.values.values.resize(12);
    const auto written = writeRgl(table);
    ASSERT_TRUE(written);
    EXPECT_EQ(written->loss.items.size(), 1U);
    const auto back = parseRgl(written->bytes, "t.bsdf");
    ASSERT_TRUE(back);
    EXPECT_EQ(back->content.channels.size(), 3U);
    for (std::size_t light = 0; light < 3; ++light) {
        for (std::size_t i = 0; i < 12; ++i) {
            EXPECT_EQ(back->content.values.values[12 * light + i],
                      table.values.values[4 * light + i % 4]);
        }
    }
}

TEST(Rgl, WarnsOfWhatItLeavesOut) {
    TensorTable table = smallTensor();
    table.channels = {{"", 400}, {"", 500}, {"", 600}};
    table.values.values[0] = -1;
    const std::string bytes = changed(writeRgl(table)->bytes, [](std::vector<TensorField>& fields) {
        TensorField rgb = field(fields, "spectra");
        rgb.name = "rgb";
        fields.push_back(rgb);
        fields.push_back({.name = "valid", .type = TensorType::U8, .shape = {1}, .data = "x"});
    });
    const auto read = parseRgl(bytes, "t.bsdf");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->warnings,
              (std::vector<std::string>{"rgb is left out: spectra are there too",
                                        "1 fields of other names are left out",
                                        "1 negative values, answered as 0"}));
}

TEST(Rgl, RefusesDamage) {
    const std::string sound = smallFile();
    EXPECT_TRUE(parseRgl(sound, "t.bsdf"));
    EXPECT_TRUE(refuses(parseRgl("", "t.bsdf"), {"rgl: t.bsdf: no tensor file"}));
    EXPECT_TRUE(refuses(parseRgl("Source Measured\n", "t.bsdf"), {"no tensor file"}));
    EXPECT_TRUE(parseRgl(sound + std::string(4, '\0'), "t.bsdf"));
    EXPECT_TRUE(refuses(parseRgl(sound + "x", "t.bsdf"), {"1 bytes behind the last field"}));
    EXPECT_TRUE(refuses(parseRgl(sound + std::string(8, '\0'), "t.bsdf"), {"8 bytes behind"}));
    std::string version = sound;
    version[12] = 2;
    EXPECT_TRUE(refuses(parseRgl(version, "t.bsdf"), {"version"}));
    for (std::size_t size = 0; size < sound.size(); ++size) {
        ASSERT_TRUE(refuses(parseRgl(std::string_view(sound).substr(0, size), "t.bsdf"))) << size;
    }
}

TEST(Rgl, RefusesFieldsThatDoNotFitTogether) {
    const std::string sound = smallFile();
    const auto with = [&](std::string_view name, auto change) {
        return parseRgl(
            changed(sound, [&](std::vector<TensorField>& f) { change(field(f, name)); }), "t.bsdf");
    };
    for (const char* name : {"description",
                             "jacobian",
                             "theta_i",
                             "phi_i",
                             "ndf",
                             "sigma",
                             "vndf",
                             "luminance",
                             "rgb"}) {
        EXPECT_TRUE(refuses(with(name, [](TensorField& f) { f.name = "other"; }),
                            {"field '" + std::string(name) + "': missing"}));
        EXPECT_TRUE(refuses(with(name, [](TensorField& f) { f.shape.push_back(1); }), {name}));
    }
    EXPECT_TRUE(refuses(with("vndf", [](TensorField& f) { std::swap(f.shape[0], f.shape[1]); }),
                        {"field 'vndf': 3 x 1 x 2 x 3 values"}));
    EXPECT_TRUE(refuses(with("ndf", [](TensorField& f) { f.shape = {1, 6}; }), {"at least 2 x 2"}));
    EXPECT_TRUE(refuses(with("ndf", [](TensorField& f) { f.type = TensorType::I32; }), {"type 6"}));
    std::string floats;
    for (const float value : {0.0F, 0.0F, 1.0F}) appendLittle(floats, value);
    EXPECT_TRUE(refuses(with("theta_i", [&](TensorField& f) { f.data = floats; }),
                        {"'theta_i': does not ascend"}));
    std::string bad;
    for (int i = 0; i < 6; ++i) appendLittle(bad, std::numeric_limits<float>::infinity());
    EXPECT_TRUE(refuses(with("ndf", [&](TensorField& f) { f.data = bad; }),
                        {"'ndf': a value is not a finite number"}));
}

}  // namespace
}  // namespace gonio::proc
