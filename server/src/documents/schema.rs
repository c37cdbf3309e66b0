//! The schema of a declared document, for the description of the interface.

use slewplan_solver::model::input::{
    InputForm, Literal, MemberBounds, MemberSchema, NamedSchema, Schema, text_of,
};
use std::borrow::Cow;
use std::marker::PhantomData;
use utoipa::openapi::schema::{
    AdditionalProperties, ArrayBuilder, KnownFormat, ObjectBuilder, OneOfBuilder, RefBuilder,
    SchemaFormat, SchemaType, Type,
};
use utoipa::openapi::{self, RefOr};
use utoipa::{Number, PartialSchema, ToSchema};

/// The schema of a declared document: a type for the attributes of `utoipa`, which cannot know the
/// types of the solver.
pub(crate) struct Described<F>(PhantomData<F>);

impl<F: InputForm> PartialSchema for Described<F> {
    fn schema() -> RefOr<openapi::Schema> {
        let named = named::<F>();
        definition(&named)
    }
}

impl<F: InputForm> ToSchema for Described<F> {
    fn name() -> Cow<'static, str> {
        named::<F>().name.into()
    }

    fn schemas(schemas: &mut Vec<(String, RefOr<openapi::Schema>)>) {
        let mut inside = Vec::new();
        components(&(named::<F>().schema)(), &mut inside);
        let schema = |named: NamedSchema| (named.name.to_owned(), definition(&named));
        schemas.extend(inside.into_iter().map(schema));
    }
}

fn named<F: InputForm>() -> NamedSchema {
    match F::schema() {
        Schema::Named(named) => named,
        schema => unreachable!("a document has a name, this is {schema:?}"),
    }
}

/// The named schemas inside a schema, each once.
fn components(schema: &Schema, found: &mut Vec<NamedSchema>) {
    match schema {
        Schema::Named(named) => {
            if !found.iter().any(|other| other.name == named.name) {
                found.push(*named);
                components(&(named.schema)(), found);
            }
        }
        Schema::List { of, .. } => components(of, found),
        Schema::Nullable(schema) => components(schema, found),
        Schema::Object(members) | Schema::OpenObject(members) => {
            for member in members {
                components(&member.schema, found);
            }
        }
        Schema::Kinds(kinds) => {
            for member in kinds.iter().flat_map(|(_, _, members)| members) {
                components(&member.schema, found);
            }
        }
        Schema::OneOf(schemas) => {
            for (_, schema) in schemas {
                components(schema, found);
            }
        }
        Schema::Number
        | Schema::Integer(_)
        | Schema::Boolean
        | Schema::Text
        | Schema::Choice(_) => {}
    }
}

/// What stands under a name.
fn definition(named: &NamedSchema) -> RefOr<openapi::Schema> {
    let text = said(text_of(named.doc));
    match (named.schema)() {
        Schema::Object(members) => object(&members)
            .description(text)
            .additional_properties(Some(AdditionalProperties::FreeForm(false)))
            .into(),
        Schema::OpenObject(members) => object(&members).description(text).into(),
        Schema::Choice(choices) => choice(text, &choices).into(),
        Schema::Kinds(kinds) => {
            let mut one_of = OneOfBuilder::new().description(text);
            for (kind, text, members) in &kinds {
                one_of = one_of.item(of_kind(kind, text, members));
            }
            one_of.into()
        }
        Schema::OneOf(schemas) => {
            let mut one_of = OneOfBuilder::new().description(text);
            for (text, schema) in &schemas {
                one_of = one_of.item(value(schema, text, &Details::default()));
            }
            one_of.into()
        }
        other => value(&other, &text.unwrap_or_default(), &Details::default()),
    }
}

fn object(members: &[MemberSchema]) -> ObjectBuilder {
    let mut object = ObjectBuilder::new().schema_type(Type::Object);
    for member in members {
        object = object.property(member.name, property(member));
        if member.required {
            object = object.required(member.name);
        }
    }
    object
}

/// One kind of a union: its members and the one that tells the kind.
fn of_kind(kind: &str, text: &str, members: &[MemberSchema]) -> ObjectBuilder {
    let kind = ObjectBuilder::new()
        .schema_type(Type::String)
        .enum_values(Some([kind]));
    object(members)
        .description(said(text.to_owned()))
        .property("kind", kind)
        .required("kind")
}

/// The texts of a choice; what each means becomes part of the description.
fn choice(text: Option<String>, choices: &[(&str, String)]) -> ObjectBuilder {
    let meanings = choices
        .iter()
        .map(|(name, text)| format!("`{name}`: {text}"));
    let lines: Vec<String> = text.into_iter().chain(meanings).collect();
    ObjectBuilder::new()
        .schema_type(Type::String)
        .description(Some(lines.join("\n")))
        .enum_values(Some(choices.iter().map(|(name, _)| *name)))
}

/// What a schema tells of a value beside its schema.
#[derive(Default)]
struct Details {
    bounds: MemberBounds,
    default: Option<Literal>,
    nullable: bool,
}

fn property(member: &MemberSchema) -> RefOr<openapi::Schema> {
    let details = Details {
        bounds: member.bounds,
        default: member.default,
        // Null counts as left out.
        nullable: !member.required,
    };
    value(&member.schema, &member.text, &details)
}

fn value(schema: &Schema, text: &str, details: &Details) -> RefOr<openapi::Schema> {
    let primitive = |kind: Type| primitive(kind, text, details);
    match schema {
        Schema::Nullable(schema) => {
            let details = Details {
                nullable: true,
                ..*details
            };
            value(schema, text, &details)
        }
        Schema::Number => primitive(Type::Number)
            .format(Some(SchemaFormat::KnownFormat(KnownFormat::Double)))
            .into(),
        Schema::Integer(format) => {
            let bounds = details.bounds;
            let format = bounds.format.unwrap_or(format).to_owned();
            primitive(Type::Integer)
                .format(Some(SchemaFormat::Custom(format)))
                .minimum(Some(Number::from(bounds.minimum.unwrap_or(0.0))))
                .into()
        }
        Schema::Boolean => primitive(Type::Boolean).into(),
        Schema::Text => primitive(Type::String).into(),
        Schema::List {
            of,
            at_least,
            at_most,
        } => ArrayBuilder::new()
            .schema_type(types(Type::Array, details.nullable))
            .items(value(of, "", &Details::default()))
            .description(said(text.to_owned()))
            .min_items(at_least.or(details.bounds.min_length))
            .max_items(at_most.or(details.bounds.max_length))
            .into(),
        Schema::Named(named) => reference(named.name, text, details.nullable),
        other => unreachable!("only names stand for {other:?}"),
    }
}

fn reference(name: &str, text: &str, nullable: bool) -> RefOr<openapi::Schema> {
    let location = format!("#/components/schemas/{name}");
    let reference = RefBuilder::new()
        .ref_location(location)
        .description(said(text.to_owned()));
    if !nullable {
        return reference.into();
    }
    let null = ObjectBuilder::new().schema_type(Type::Null);
    OneOfBuilder::new().item(reference).item(null).into()
}

fn primitive(kind: Type, text: &str, details: &Details) -> ObjectBuilder {
    let bounds = &details.bounds;
    let number = |bound: Option<f64>| bound.map(Number::from);
    ObjectBuilder::new()
        .schema_type(types(kind, details.nullable))
        .description(said(text.to_owned()))
        .default(details.default.map(|value| match value {
            Literal::Number(value) => value.into(),
            Literal::Integer(value) => value.into(),
            Literal::Boolean(value) => value.into(),
        }))
        .minimum(number(bounds.minimum))
        .exclusive_minimum(number(bounds.exclusive_minimum))
        .maximum(number(bounds.maximum))
        .exclusive_maximum(number(bounds.exclusive_maximum))
        .min_length(bounds.min_length)
        .pattern(bounds.pattern)
}

fn types(kind: Type, nullable: bool) -> SchemaType {
    if nullable {
        SchemaType::Array(vec![kind, Type::Null])
    } else {
        SchemaType::Type(kind)
    }
}

/// No description rather than an empty one.
fn said(text: String) -> Option<String> {
    Some(text).filter(|text| !text.is_empty())
}
