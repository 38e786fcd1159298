#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "anatomy/build.h"
#include "core/hash.h"

namespace cathlab {
namespace {

constexpr char magic[8] = {'c', 'a', 't', 'h', 'a', 'n', 'a', '1'};

/// Writes a model as bytes (the machine's own byte order: a cache never travels).
class Writer {
public:
    std::string bytes;
    template <class T>
    void plain(const T& v) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
    }
    void item(const std::string& s) {
        plain(static_cast<std::uint64_t>(s.size()));
        bytes += s;
    }
    void item(double v) { plain(v); }
    void item(Index v) { plain(v); }
    void item(std::uint64_t v) { plain(v); }
    void item(const Vec3& v) { bytes.append(reinterpret_cast<const char*>(v.data()), 3 * sizeof(double)); }
    void item(const Triangle& v) { bytes.append(reinterpret_cast<const char*>(v.data()), 3 * sizeof(Index)); }
    void item(const std::pair<Index, Index>& e) {
        plain(e.first);
        plain(e.second);
    }
    void item(const Pose& p) {
        item(p.position);
        bytes.append(reinterpret_cast<const char*>(p.orientation.coeffs().data()), 4 * sizeof(double));
    }
    template <class T>
    void list(const std::vector<T>& v) {
        plain(static_cast<std::uint64_t>(v.size()));
        for (const T& x : v) item(x);
    }
    template <class T>
    void maybe(const std::optional<T>& v) {
        plain(static_cast<std::uint8_t>(v ? 1 : 0));
        if (v) item(*v);
    }
    void item(const TriMesh& m) {
        list(m.vertices);
        list(m.triangles);
    }
    void item(const CentrelineNode& n) { item(n.position), item(n.radius), item(n.region); }
    void item(const Region& r) {
        item(r.name), item(r.wall_thickness_mm), item(r.force_limit_n), item(r.particle_spacing_mm);
    }
    void item(const EntrySite& e) { item(e.name), item(e.pose), item(e.radius_mm), item(e.node); }
    void item(const FixedZone& f) {
        item(f.name), item(f.center), item(f.normal), item(f.radius_mm), item(f.half_thickness_mm);
    }
    void item(const Landmark& l) { item(l.name), item(l.pose), item(l.radius_mm), item(l.node); }
    void item(const Annulus& a) { item(a.pose), item(a.radius_mm); }
    void item(const ContextSolid& c) { item(c.name), item(c.material), item(c.inside), item(c.mesh); }
};

/// Reads the same; `good` falls when the bytes end too soon.
class Reader {
public:
    explicit Reader(std::string_view bytes) : rest_(bytes) {}
    bool good = true;
    bool done() const { return rest_.empty(); }
    void raw(void* out, std::size_t size) {
        if (!good || rest_.size() < size) {
            good = false;
            return;
        }
        std::copy(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(size), static_cast<char*>(out));
        rest_.remove_prefix(size);
    }
    void item(std::string& s) {
        std::uint64_t n = 0;
        raw(&n, sizeof n);
        if (!good || n > rest_.size()) {
            good = false;
            return;
        }
        s.assign(rest_.substr(0, n));
        rest_.remove_prefix(n);
    }
    void item(double& v) { raw(&v, sizeof v); }
    void item(Index& v) { raw(&v, sizeof v); }
    void item(std::uint64_t& v) { raw(&v, sizeof v); }
    void item(Vec3& v) { raw(v.data(), 3 * sizeof(double)); }
    void item(Triangle& v) { raw(v.data(), 3 * sizeof(Index)); }
    void item(std::pair<Index, Index>& e) { item(e.first), item(e.second); }
    void item(Pose& p) { item(p.position), raw(p.orientation.coeffs().data(), 4 * sizeof(double)); }
    template <class T>
    void list(std::vector<T>& v) {
        std::uint64_t n = 0;
        raw(&n, sizeof n);
        if (!good || n > rest_.size()) {  // every item has at least one byte
            good = false;
            return;
        }
        v.resize(n);
        for (T& x : v) item(x);
    }
    template <class T>
    void maybe(std::optional<T>& v) {
        std::uint8_t there = 0;
        raw(&there, 1);
        v.reset();
        if (good && there == 1) item(v.emplace());
        good = good && there <= 1;
    }
    void item(TriMesh& m) { list(m.vertices), list(m.triangles); }
    void item(CentrelineNode& n) { item(n.position), item(n.radius), item(n.region); }
    void item(Region& r) {
        item(r.name), item(r.wall_thickness_mm), item(r.force_limit_n), item(r.particle_spacing_mm);
    }
    void item(EntrySite& e) { item(e.name), item(e.pose), item(e.radius_mm), item(e.node); }
    void item(FixedZone& f) {
        item(f.name), item(f.center), item(f.normal), item(f.radius_mm), item(f.half_thickness_mm);
    }
    void item(Landmark& l) { item(l.name), item(l.pose), item(l.radius_mm), item(l.node); }
    void item(Annulus& a) { item(a.pose), item(a.radius_mm); }
    void item(ContextSolid& c) { item(c.name), item(c.material), item(c.inside), item(c.mesh); }

private:
    std::string_view rest_;
};

template <class Stream, class Model>
void fields(Stream& s, Model& m) {
    s.item(m.name), s.item(m.content_hash);
    s.item(m.fine), s.list(m.fine_region), s.list(m.fine_radius);
    s.item(m.lumen), s.list(m.lumen_region), s.list(m.lumen_radius);
    s.list(m.centreline.nodes), s.list(m.centreline.edges);
    s.list(m.regions), s.list(m.entries), s.list(m.fixed), s.list(m.landmarks), s.maybe(m.annulus), s.list(m.context);
}

std::uint64_t hash_of(std::string_view bytes) {
    Hash64 h;
    h.bytes(bytes.data(), bytes.size());
    return h.value();
}

/// The file: magic, key, hash of the body, body.
std::optional<AnatomyModel> read_cache(const std::string& path, std::uint64_t key) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    std::ostringstream all;
    all << file.rdbuf();
    const std::string bytes = std::move(all).str();
    constexpr std::size_t head = sizeof magic + 2 * sizeof(std::uint64_t);
    if (bytes.size() < head || bytes.compare(0, sizeof magic, magic, sizeof magic) != 0) return std::nullopt;
    Reader reader(bytes);
    char found[sizeof magic];
    std::uint64_t found_key = 0;
    std::uint64_t found_hash = 0;
    reader.raw(found, sizeof found);
    reader.item(found_key);
    reader.item(found_hash);
    if (found_key != key || found_hash != hash_of(std::string_view(bytes).substr(head))) return std::nullopt;
    AnatomyModel model;
    fields(reader, model);
    if (!reader.good || !reader.done() || model.content_hash != key) return std::nullopt;
    return model;
}

void write_cache(const std::string& path, std::uint64_t key, const AnatomyModel& model) {
    Writer body;
    fields(body, model);
    Writer head;
    head.bytes.assign(magic, sizeof magic);
    head.item(key);
    head.item(hash_of(body.bytes));
    // a name of its own for each process and model, renamed when whole: two builders at once cannot mix their bytes
    const std::string part =
        path + "." + hash_text(hash_of(body.bytes) ^ reinterpret_cast<std::uintptr_t>(&body)) + ".part";
    std::error_code error;
    bool written = false;
    {
        std::ofstream file(part, std::ios::binary);
        file << head.bytes << body.bytes;
        file.flush();
        written = file.good();
    }
    if (written) std::filesystem::rename(part, path, error);
    if (!written || error) std::filesystem::remove(part, error);  // no cache is no failure: the next load builds again
}

template <class Spec, class Build>
AnatomyModel load_or(const Spec& spec, const std::string& folder, Build&& build) {
    if (folder.empty()) return build();
    Hash64 h;
    h.word(content_hash(spec));
    h.word(anatomy_builder_version);
    const std::uint64_t key = h.value();
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    const std::string path = (std::filesystem::path(folder) / ("anatomy-" + hash_text(key) + ".bin")).string();
    if (std::optional<AnatomyModel> kept = read_cache(path, key)) return *std::move(kept);
    AnatomyModel model = build();
    write_cache(path, key, model);
    return model;
}

}  // namespace

AnatomyModel load_or_build(const AnatomySpec& spec, const std::string& cache_folder, const Workers& workers,
                           const BuildProgress& progress) {
    validate(spec);
    return load_or(spec, cache_folder, [&] { return build_anatomy(spec, workers, progress); });
}

AnatomyModel load_or_build(const ImportedAnatomySpec& spec, const std::string& cache_folder, const Workers& workers,
                           const BuildProgress& progress) {
    validate(spec);
    return load_or(spec, cache_folder, [&] { return import_anatomy(spec, workers, progress); });
}

std::uint64_t model_hash(const AnatomyModel& model) {
    Writer w;
    fields(w, model);
    return hash_of(w.bytes);
}

}  // namespace cathlab
