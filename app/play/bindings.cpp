#include "play/bindings.h"

#include <algorithm>

#include "core/errors.h"

namespace cathlab::play {

std::optional<Control> Bindings::bind(Control control, const Source& source) {
    std::optional<Control> taken;
    for (std::size_t i = 0; i < control_count; ++i) {
        const auto same = [&](const Source& s) { return s.kind == source.kind && s.code == source.code; };
        if (std::erase_if(sources[i], same) > 0 && static_cast<Control>(i) != control) taken = static_cast<Control>(i);
    }
    of(control).push_back(source);
    return taken;
}

std::string Bindings::labels(Control control, bool pad) const {
    std::string out;
    for (const Source& source : of(control))
        if (source.of_pad() == pad) out += (out.empty() ? "" : ", ") + source_label(source);
    return out;
}

Bindings default_bindings() {
    Bindings out;
    for (const ControlInfo& info : control_table())
        for (const std::string_view text : info.sources) out.of(info.control).push_back(parse_source(text));
    return out;
}

Table<Bindings> bindings_table() {
    Table<Bindings> table("which key, button, stick or trigger does what; ':-' after it turns it round");
    for (const ControlInfo& info : control_table()) {
        FieldSpec field;
        field.key = std::string(info.name);
        field.kind = FieldKind::texts;
        field.doc = std::string(info.doc);
        field.count = {0, 12};
        const Control control = info.control;
        field.store = [control](void* object, const FieldValue& value) {
            std::vector<Source> sources;
            for (const std::string& text : std::get<std::vector<std::string>>(value))
                sources.push_back(parse_source(text));
            static_cast<Bindings*>(object)->of(control) = std::move(sources);
        };
        field.load = [control](const void* object) -> FieldValue {
            std::vector<std::string> texts;
            for (const Source& source : static_cast<const Bindings*>(object)->of(control))
                texts.push_back(source_text(source));
            return texts;
        };
        table.field(std::move(field));
    }
    return table;
}

}  // namespace cathlab::play
