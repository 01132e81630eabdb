#include "engine/core/spirv_words.h"

#include <algorithm>
#include <numeric>

namespace twinray {
namespace {

using spirv::Op, spirv::Words;
using spirv::op_of, spirv::words_of, spirv::first_word;
using Id = std::uint32_t;

constexpr std::size_t none = ~std::size_t{0};

// Places are positions of instructions in the module's words.
struct Block {
    Id label;
    std::size_t begin, last, end;  // its OpLabel, its terminator, the position after it
    std::size_t merge = none;      // its OpSelectionMerge or OpLoopMerge
    bool is_live = false;
    bool is_needed = false;       // a live block needs it as merge block or continue target
    std::optional<Id> loop = {};  // the loop that it is the continue target of
};

struct Function {
    std::size_t begin, body, end;  // its OpFunction, its first OpLabel, the position after its OpFunctionEnd
    std::vector<Block> blocks = {};
    bool is_live = false;
};

class Pruner {
  public:
    explicit Pruner(Words module)
        : module_(module),
          ids_(module[3]),
          is_type_(ids_),
          is_gone_(ids_),
          is_vector_(ids_),
          is_word_(ids_),
          known_(ids_),
          same_(ids_),
          composite_(ids_, none),
          index_(ids_) {
        std::iota(same_.begin(), same_.end(), Id{0});
    }

    std::vector<std::uint32_t> pruned() {
        if (!read()) return {module_.begin(), module_.end()};
        for (const Id entry : entries_) visit(index_[entry]);
        for (const Function& function : functions_) note_what_goes(function);
        write();
        return std::move(out_);
    }

  private:
    Words at(std::size_t place) const { return module_.subspan(place, words_of(module_[place])); }
    Op op_at(std::size_t place) const { return op_of(module_[place]); }
    template <class Visit>
    void each(std::size_t begin, std::size_t end, const Visit& visit) const {
        for (std::size_t place = begin; place < end; place += words_of(module_[place])) visit(place, at(place));
    }

    // Returns false for a module whose parts refer to each other in ways that are not followed here.
    bool read() {
        std::size_t place = spirv::header_words;
        for (; place < module_.size() && op_at(place) != Op::Function; place += words_of(module_[place]))
            if (!read_global(at(place))) return false;
        first_function_ = place;
        while (place < module_.size()) {
            place = read_function(place);
            if (functions_.back().blocks.empty()) return false;
        }
        return !functions_.empty();
    }

    bool read_global(Words instruction) {
        const Op op = op_of(instruction[0]);
        switch (op) {
            using enum Op;
            case EntryPoint: entries_.push_back(instruction[2]); break;
            case ConstantTrue: known_[instruction[2]] = 1; break;
            case ConstantFalse: known_[instruction[2]] = 0; break;
            case Constant:
                if (is_word_[instruction[1]]) known_[instruction[2]] = instruction[3];
                break;
            case GroupDecorate: return false;
            case ExtInstImport: {
                const std::string_view name(reinterpret_cast<const char*>(&instruction[2]));
                return name.find("DebugInfo") == std::string_view::npos;
            }
            default:
                if (spirv::is_type(op)) read_type(instruction);
        }
        return true;
    }

    void read_type(Words instruction) {
        const Op op = op_of(instruction[0]);
        is_type_[instruction[1]] = true;
        is_vector_[instruction[1]] = op == Op::TypeVector;
        is_word_[instruction[1]] = op == Op::TypeBool || (op == Op::TypeInt && instruction[2] == 32);
    }

    std::size_t read_function(std::size_t begin) {
        Function function{begin, none, begin};
        std::size_t place = begin;
        for (Op op = Op::Function; op != Op::FunctionEnd && place < module_.size(); place += words_of(module_[place])) {
            op = op_at(place);
            std::vector<Block>& blocks = function.blocks;
            if (op == Op::Label) {
                if (blocks.empty()) function.body = place;
                index_[module_[place + 1]] = blocks.size();
                blocks.push_back({module_[place + 1], place, place, place});
            }
            if (blocks.empty() || op == Op::FunctionEnd || op == Op::Line || op == Op::NoLine) continue;
            if (op == Op::SelectionMerge || op == Op::LoopMerge) blocks.back().merge = place;
            if (op == Op::CompositeConstruct && !is_vector_[module_[place + 1]]) composite_[module_[place + 2]] = place;
            if (op == Op::CompositeExtract) same_[module_[place + 2]] = part_of(at(place));
            blocks.back().last = place;
            blocks.back().end = place + words_of(module_[place]);
        }
        function.end = place;
        index_[module_[begin + 2]] = functions_.size();
        functions_.push_back(std::move(function));
        return place;
    }

    // Returns the value that was put where an instruction takes one out; the instruction's own result if it is unknown.
    Id part_of(Words extract) const {
        Id part = same_[extract[3]];
        for (const std::uint32_t number : extract.subspan(4)) {
            if (composite_[part] == none || number + 3 >= at(composite_[part]).size()) return extract[2];
            part = same_[module_[composite_[part] + 3 + number]];
        }
        return part;
    }

    std::optional<std::uint32_t> known(Id id) const { return known_[same_[id]]; }

    void visit(std::size_t index) {
        Function& function = functions_[index];
        if (function.is_live) return;
        function.is_live = true;
        do find_live_blocks(function);
        while (learn(function));
        note_needed_blocks(function);
        for (const Block& block : function.blocks)
            if (block.is_live)
                each(block.begin, block.end, [&](std::size_t, Words instruction) {
                    if (op_of(instruction[0]) == Op::FunctionCall) visit(index_[instruction[3]]);
                });
    }

    void find_live_blocks(Function& function) {
        for (Block& block : function.blocks) block.is_live = false;
        std::vector<std::size_t> waiting = {0};
        function.blocks[0].is_live = true;
        while (!waiting.empty()) {
            const Block& block = function.blocks[waiting.back()];
            waiting.pop_back();
            for (const std::size_t next : successors(function, block)) {
                if (!function.blocks[next].is_live) waiting.push_back(next);
                function.blocks[next].is_live = true;
            }
        }
    }

    // Returns the block that a known condition leads to. Branches back to a loop's head stay: a loop must have one.
    std::optional<Id> only_successor(const Block& block) const {
        const Words branch = at(block.last);
        if (op_of(branch[0]) != Op::BranchConditional || !known(branch[1])) return {};
        if (std::min(index_[branch[2]], index_[branch[3]]) <= index_[block.label]) return {};
        return *known(branch[1]) ? branch[2] : branch[3];
    }

    // Returns the blocks that words of a terminator name; a case of a switch may name one by chance.
    std::vector<std::size_t> successors(const Function& function, const Block& block) const {
        if (const std::optional<Id> only = only_successor(block)) return {index_[*only]};
        std::vector<std::size_t> found;
        for (const Id word : at(block.last).subspan(1))
            if (word < ids_ && index_[word] < function.blocks.size() && function.blocks[index_[word]].label == word)
                found.push_back(index_[word]);
        return found;
    }

    // Derives booleans and whole numbers from known ones. Returns false if there were none.
    bool learn(const Function& function) {
        bool has_learnt = false;
        for (const Block& block : function.blocks) {
            if (!block.is_live) continue;
            each(block.begin, block.last, [&](std::size_t, Words instruction) {
                if (instruction.size() < 4 || !is_word_[instruction[1]] || known(instruction[2])) return;
                known_[instruction[2]] = value_of(function, block, instruction);
                has_learnt = has_learnt || known_[instruction[2]];
            });
        }
        return has_learnt;
    }

    std::optional<std::uint32_t> value_of(const Function& function, const Block& block, Words instruction) const {
        const Op op = op_of(instruction[0]);
        if (op == Op::Phi) return value_of_phi(function, block, instruction);
        if (op < spirv::first_operation || op > spirv::last_operation) return {};
        std::optional<std::uint32_t> operands[3];
        for (std::size_t i = 0; i < 3; ++i) operands[i] = i + 3 < instruction.size() ? known(instruction[i + 3]) : 0;
        const auto& [a, b, c] = operands;
        if ((op == Op::LogicalAnd || op == Op::BitwiseAnd) && (a == 0 || b == 0)) return 0;
        if (op == Op::LogicalOr && (a == 1 || b == 1)) return 1;
        if (op == Op::Select && a) return *a ? b : c;
        return a && b && c ? spirv::evaluate(op, *a, *b, *c) : std::nullopt;
    }

    // A loop may pass a value around unchanged.
    std::optional<std::uint32_t> value_of_phi(const Function& function, const Block& block, Words phi) const {
        std::optional<std::uint32_t> value;
        for (std::size_t i = 3; i < phi.size(); i += 2) {
            if (same_[phi[i]] == phi[2] || !is_edge(function, phi[i + 1], block.label)) continue;
            if (!known(phi[i]) || (value && value != known(phi[i]))) return {};
            value = known(phi[i]);
        }
        return value;
    }

    bool is_edge(const Function& function, Id from, Id to) const {
        const Block& block = function.blocks[index_[from]];
        if (!block.is_live) return false;
        const std::vector<std::size_t> next = successors(function, block);
        return std::find(next.begin(), next.end(), index_[to]) != next.end();
    }

    bool keeps_merge(const Block& block) const {
        return block.merge != none && (op_at(block.merge) == Op::LoopMerge || !only_successor(block));
    }

    void note_needed_blocks(Function& function) {
        for (const Block& block : function.blocks) {
            if (!block.is_live || !keeps_merge(block)) continue;
            const Words merge = at(block.merge);
            function.blocks[index_[merge[1]]].is_needed = true;
            if (op_of(merge[0]) != Op::LoopMerge) continue;
            Block& target = function.blocks[index_[merge[2]]];
            target.is_needed = true;
            target.loop = block.label;
        }
    }

    void note_what_goes(const Function& function) {
        if (!function.is_live) return note_results(function.begin, function.end);
        for (const Block& block : function.blocks) {
            if (block.is_live) continue;
            note_results(block.begin, block.end);
            if (block.is_needed) is_gone_[block.label] = false;
        }
    }

    // An instruction of a function has a result if its first operand is a type.
    void note_results(std::size_t begin, std::size_t end) {
        each(begin, end, [&](std::size_t, Words instruction) {
            if (op_of(instruction[0]) == Op::Label) is_gone_[instruction[1]] = true;
            if (instruction.size() > 2 && instruction[1] < ids_ && is_type_[instruction[1]])
                is_gone_[instruction[2]] = true;
        });
    }

    void write() {
        out_.assign(module_.begin(), module_.begin() + spirv::header_words);
        each(spirv::header_words, first_function_, [&](std::size_t, Words instruction) {
            if (!spirv::is_annotation(op_of(instruction[0])) || !is_gone_[instruction[1]]) put(instruction);
        });
        for (const Function& function : functions_)
            if (function.is_live) write_function(function);
        out_[3] = ids_ + static_cast<std::uint32_t>(undefined_.size());
    }

    void write_function(const Function& function) {
        put(module_.subspan(function.begin, function.body - function.begin));
        for (const Block& block : function.blocks)
            if (block.is_live)
                write_live(function, block);
            else if (block.is_needed)
                write_unreachable(block);
        put({first_word(Op::FunctionEnd, 1)});
    }

    void write_live(const Function& function, const Block& block) {
        each(block.begin, block.end, [&](std::size_t place, Words instruction) {
            if (op_of(instruction[0]) == Op::Phi) return write_phi(function, block, instruction);
            if (place == block.merge && !keeps_merge(block)) return;
            if (place != block.last) return put(instruction);
            if (const std::optional<Id> only = only_successor(block)) return put({first_word(Op::Branch, 2), *only});
            put(instruction);
        });
    }

    void write_phi(const Function& function, const Block& block, Words phi) {
        std::vector<std::uint32_t> words(phi.begin(), phi.begin() + 3);
        for (std::size_t i = 3; i < phi.size(); i += 2)
            if (is_edge(function, phi[i + 1], block.label)) words.insert(words.end(), {phi[i], phi[i + 1]});
        if (const std::optional<Id> back = unreachable_back_edge(function, block)) {
            undefined_.push_back({phi[1], ids_ + static_cast<std::uint32_t>(undefined_.size()), block.label});
            words.insert(words.end(), {undefined_.back().id, *back});
        }
        words[0] = first_word(Op::Phi, words.size());
        put(words);
    }

    // Returns the continue target of a loop whose body never gets there.
    std::optional<Id> unreachable_back_edge(const Function& function, const Block& block) const {
        if (block.merge == none || op_at(block.merge) != Op::LoopMerge) return {};
        const Block& target = function.blocks[index_[at(block.merge)[2]]];
        return target.is_live ? std::nullopt : std::optional(target.label);
    }

    void write_unreachable(const Block& block) {
        put({first_word(Op::Label, 2), block.label});
        if (!block.loop) return put({first_word(Op::Unreachable, 1)});
        for (const Undefined& value : undefined_)
            if (value.loop == *block.loop) put({first_word(Op::Undef, 3), value.type, value.id});
        put({first_word(Op::Branch, 2), *block.loop});
    }

    void put(Words words) { out_.insert(out_.end(), words.begin(), words.end()); }
    void put(std::initializer_list<std::uint32_t> words) { out_.insert(out_.end(), words); }

    struct Undefined {
        Id type, id, loop;
    };

    Words module_;
    std::uint32_t ids_;  // less than it, each
    std::size_t first_function_ = 0;
    std::vector<bool> is_type_, is_gone_;    // by id
    std::vector<bool> is_vector_, is_word_;  // by id of a type; a word: a boolean or a whole number of 32 bits
    std::vector<std::optional<std::uint32_t>> known_;  // by id of a word
    std::vector<Id> same_;                             // the value in place of an id
    std::vector<std::size_t> composite_;               // by id: the place where its parts are put together, or none
    std::vector<std::size_t> index_;                   // of a function, and of a block in its function, by id
    std::vector<Id> entries_;
    std::vector<Function> functions_;
    std::vector<Undefined> undefined_;  // the values from a back edge that is never taken
    std::vector<std::uint32_t> out_;
};

}  // namespace

std::vector<std::uint32_t> prune_branches(std::span<const std::uint32_t> spirv) { return Pruner(spirv).pruned(); }

}  // namespace twinray
