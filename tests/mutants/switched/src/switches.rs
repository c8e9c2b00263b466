//! Where mutants act, and what stands there instead.

use crate::edits::Edits;
use crate::{Mutant, Place};
use proc_macro2::{LineColumn, Span};
use quote::ToTokens;
use std::collections::{BTreeSet, HashMap};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

pub(crate) struct Switches {
    edits: Edits,
    mutants: HashMap<(usize, usize), Vec<Mutant>>,
    switched: BTreeSet<u32>,
}

/// `crate::__on(id)`.
fn on(mutant: &Mutant) -> String {
    format!("crate::__on({})", mutant.id)
}

impl Switches {
    pub(crate) fn new(edits: Edits, mutants: &[Mutant]) -> Self {
        let mut by_place: HashMap<_, Vec<Mutant>> = HashMap::new();
        for mutant in mutants {
            let Place { line, column } = mutant.span.start;
            by_place
                .entry((line, column))
                .or_default()
                .push(mutant.clone());
        }
        Self {
            edits,
            mutants: by_place,
            switched: BTreeSet::new(),
        }
    }

    /// The text with its switches, and the mutants that have one.
    pub(crate) fn finish(self) -> (String, BTreeSet<u32>) {
        (self.edits.finish(), self.switched)
    }

    /// The mutants of a genre that begin at a place; they get a switch.
    fn take(&mut self, at: LineColumn, genre: &str) -> Vec<Mutant> {
        let here = self.mutants.get(&(at.line, at.column + 1));
        let here: Vec<Mutant> = here
            .into_iter()
            .flatten()
            .filter(|mutant| mutant.genre == genre)
            .cloned()
            .collect();
        self.switched.extend(here.iter().map(|mutant| mutant.id));
        here
    }

    fn bytes(&self, span: Span) -> (usize, usize) {
        (self.edits.at(span.start()), self.edits.at(span.end()))
    }

    /// A function that returns something else at once; not of another type, where the type has no name.
    fn function(&mut self, signature: &syn::Signature, body: &syn::Block) {
        let returned = signature.output.to_token_stream().to_string();
        let named = !returned.split_whitespace().any(|word| word == "impl");
        if let Some(first) = body.stmts.first().filter(|_| named) {
            let mutants = self.take(first.span().start(), "FnValue");
            let at = self.edits.at(body.brace_token.span.open().end());
            for mutant in mutants {
                let value = &mutant.replacement;
                self.edits
                    .begin(at, &format!(" if {} {{ return {value}; }}", on(&mutant)));
            }
        }
        self.visit_block(body);
    }

    /// `a += b`: the right side comes first, and once.
    fn assignment(&mut self, binary: &syn::ExprBinary, operator: &str, mutants: &[Mutant]) {
        let ((start, end), (operator_at, operand_at)) =
            (self.bytes(binary.span()), self.bytes(binary.op.span()));
        let left = self.edits.text(start, operator_at).to_owned();
        let mut tail = "); ".to_owned();
        for mutant in mutants {
            let other = &mutant.replacement;
            tail += &format!("if {} {{ {left} {other} __r; }} else ", on(mutant));
        }
        tail += &format!("{{ {left} {operator} __r; }} }})");
        self.edits
            .replace(start, operand_at, "({ let __r = (".to_owned());
        self.visit_expr(&binary.right);
        self.edits.end(end, &tail);
    }

    /// `a && b` and `a || b`: the right side is asked for where it would be.
    fn junction(&mut self, binary: &syn::ExprBinary, operator: &str, mutant: &Mutant) {
        let ((start, end), (operator_at, operand_at)) =
            (self.bytes(binary.span()), self.bytes(binary.op.span()));
        let (is, result) = if operator == "&&" {
            ("==", "__f")
        } else {
            ("!=", "!__f")
        };
        let middle = format!(
            "); let __f = {}; if __l {is} __f {{ {result} }} else {{ ",
            on(mutant)
        );
        self.edits.begin(start, "({ let __l = (");
        self.visit_expr(&binary.left);
        self.edits.replace(operator_at, operand_at, middle);
        self.visit_expr(&binary.right);
        self.edits.end(end, " } })");
    }

    /// `a + b` and `a < b`, which does not move what it compares.
    fn operation(&mut self, binary: &syn::ExprBinary, operator: &str, mutants: &[Mutant]) {
        let ((start, end), (operator_at, operand_at)) =
            (self.bytes(binary.span()), self.bytes(binary.op.span()));
        let compares = ["==", "!=", "<", ">", "<=", ">="].contains(&operator);
        let (borrow, value) = if compares { ("&", "*") } else { ("", "") };
        let mut tail = "); ".to_owned();
        for mutant in mutants {
            let other = &mutant.replacement;
            tail += &format!(
                "if {} {{ {value}__l {other} {value}__r }} else ",
                on(mutant)
            );
        }
        tail += &format!("{{ {value}__l {operator} {value}__r }} }})");
        self.edits.begin(start, &format!("({{ let __l = {borrow}("));
        self.visit_expr(&binary.left);
        self.edits
            .replace(operator_at, operand_at, format!("); let __r = {borrow}("));
        self.visit_expr(&binary.right);
        self.edits.end(end, &tail);
    }

    /// An arm that is left out, or whose condition is always or never so.
    fn arm(&mut self, arm: &syn::Arm) {
        let left_out = self.take(arm.span().start(), "MatchArm");
        let kept: String = left_out
            .iter()
            .map(|mutant| format!("!{} && ", on(mutant)))
            .collect();
        match &arm.guard {
            Some((_, condition)) if !has_let(condition) => {
                let (start, end) = self.bytes(condition.span());
                let mut text = format!("{kept}(");
                for mutant in self.take(condition.span().start(), "MatchArmGuard") {
                    text += &format!("if {} {{ {} }} else ", on(&mutant), mutant.replacement);
                }
                self.edits.begin(start, &format!("{text}{{"));
                self.visit_expr(condition);
                self.edits.end(end, "})");
            }
            None if !kept.is_empty() => {
                let at = self.edits.at(arm.pat.span().end());
                self.edits.end(at, &format!(" if {kept}true"));
            }
            _ => {}
        }
        self.visit_expr(&arm.body);
    }
}

/// Whether a condition matches a pattern: it can't be bound to a name.
fn has_let(condition: &syn::Expr) -> bool {
    match condition {
        syn::Expr::Let(_) => true,
        syn::Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}

/// Whether this is only there in tests.
fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let text = attribute.to_token_stream().to_string();
        text == "# [test]" || (text.contains("cfg") && text.contains("test"))
    })
}

impl<'a> Visit<'a> for Switches {
    fn visit_item_fn(&mut self, function: &'a syn::ItemFn) {
        if !is_test(&function.attrs) {
            self.function(&function.sig, &function.block);
        }
    }

    fn visit_impl_item_fn(&mut self, function: &'a syn::ImplItemFn) {
        if !is_test(&function.attrs) {
            self.function(&function.sig, &function.block);
        }
    }

    fn visit_trait_item_fn(&mut self, function: &'a syn::TraitItemFn) {
        if let Some(body) = &function.default {
            self.function(&function.sig, body);
        }
    }

    fn visit_item_mod(&mut self, module: &'a syn::ItemMod) {
        if !is_test(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    // what is computed while the program is compiled knows no switch

    fn visit_item_const(&mut self, _: &'a syn::ItemConst) {}
    fn visit_item_static(&mut self, _: &'a syn::ItemStatic) {}
    fn visit_impl_item_const(&mut self, _: &'a syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'a syn::TraitItemConst) {}
    fn visit_type(&mut self, _: &'a syn::Type) {}
    fn visit_generic_argument(&mut self, _: &'a syn::GenericArgument) {}
    fn visit_pat(&mut self, _: &'a syn::Pat) {}

    fn visit_expr_repeat(&mut self, repeat: &'a syn::ExprRepeat) {
        self.visit_expr(&repeat.expr);
    }

    fn visit_expr_match(&mut self, expression: &'a syn::ExprMatch) {
        self.visit_expr(&expression.expr);
        for arm in &expression.arms {
            self.arm(arm);
        }
    }

    fn visit_expr_unary(&mut self, unary: &'a syn::ExprUnary) {
        let mutants = self.take(unary.span().start(), "UnaryOperator");
        let Some(mutant) = mutants.first() else {
            return visit::visit_expr_unary(self, unary);
        };
        let ((start, end), (operand_at, _)) =
            (self.bytes(unary.span()), self.bytes(unary.expr.span()));
        let operator = self.edits.text(start, operand_at).trim().to_owned();
        self.edits
            .replace(start, operand_at, "({ let __v = (".to_owned());
        self.visit_expr(&unary.expr);
        let tail = format!(
            "); if {} {{ __v }} else {{ {operator}__v }} }})",
            on(mutant)
        );
        self.edits.end(end, &tail);
    }

    fn visit_expr_binary(&mut self, binary: &'a syn::ExprBinary) {
        if has_let(&binary.left) || has_let(&binary.right) {
            return visit::visit_expr_binary(self, binary);
        }
        let mutants = self.take(binary.op.span().start(), "BinaryOperator");
        let (start, end) = self.bytes(binary.op.span());
        let operator = self.edits.text(start, end).to_owned();
        match (mutants.as_slice(), operator.as_str()) {
            ([], _) => visit::visit_expr_binary(self, binary),
            ([first, ..], "&&" | "||") => self.junction(binary, &operator, first),
            (_, "==" | "!=" | "<=" | ">=") => self.operation(binary, &operator, &mutants),
            _ if operator.ends_with('=') => self.assignment(binary, &operator, &mutants),
            _ => self.operation(binary, &operator, &mutants),
        }
    }
}
