//! Types read from the values of a problem file.
//!
//! `toml` has deserializers of its own. They are generic in the type that is read four times over (for values, tables, dates
//! and values with their place), which made them a seventh of the program. The one here reads the same values in the same way, says
//! the same of what does not fit, and borrows the tree that is there already instead of parsing the text again.

use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeSeed, Deserializer, EnumAccess, Error, Expected, IntoDeserializer, MapAccess,
    SeqAccess, Unexpected, VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;
use std::fmt::{self, Display, Formatter};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeFloat, DeInteger, DeString, DeTable, DeValue};

/// What does not fit the type that is read, and where in the text of the file it stands.
#[derive(Debug)]
pub(crate) struct Misfit(Box<Told>);

#[derive(Debug)]
struct Told {
    message: String,
    place: Option<Range<usize>>,
}

impl Misfit {
    fn at(place: Range<usize>, message: String) -> Misfit {
        Misfit(Box::new(Told { message, place: Some(place) }))
    }

    /// What was found and what was expected.
    pub fn message(&self) -> &str {
        &self.0.message
    }

    /// The bytes of the text that it is about, if it is known which.
    pub fn span(&self) -> Option<Range<usize>> {
        self.0.place.clone()
    }

    /// The same, within this place unless a place further inside is known.
    fn within(mut self, place: &Range<usize>) -> Misfit {
        self.0.place.get_or_insert_with(|| place.clone());
        self
    }
}

impl Error for Misfit {
    fn custom<T: Display>(message: T) -> Misfit {
        Misfit(Box::new(Told { message: message.to_string(), place: None }))
    }
}

impl std::error::Error for Misfit {}

impl Display for Misfit {
    fn fmt(&self, to: &mut Formatter) -> fmt::Result {
        to.write_str(self.message())
    }
}

/// The deserializer of a value of the file.
pub(crate) struct Reader<'t> {
    value: Given<'t>,
    place: Range<usize>,
}

/// A value of the file.
enum Given<'t> {
    Text(&'t str),
    Integer(&'t DeInteger<'t>),
    Real(&'t DeFloat<'t>),
    Truth(bool),
    Date,
    Array(&'t [Spanned<DeValue<'t>>]),
    Table(&'t DeTable<'t>),
}

/// The parts of a table that are still to be read.
type Entries<'t> = <&'t DeTable<'t> as IntoIterator>::IntoIter;

impl<'t> Reader<'t> {
    /// Of a whole file, or of a table that was put together.
    pub fn of_table(table: &'t DeTable<'t>, place: Range<usize>) -> Reader<'t> {
        Reader { value: Given::Table(table), place }
    }

    fn of(value: &'t Spanned<DeValue<'t>>) -> Reader<'t> {
        let given = match value.get_ref() {
            DeValue::String(text) => Given::Text(text),
            DeValue::Integer(number) => Given::Integer(number),
            DeValue::Float(number) => Given::Real(number),
            DeValue::Boolean(truth) => Given::Truth(*truth),
            DeValue::Datetime(_) => Given::Date,
            DeValue::Array(values) => Given::Array(values),
            DeValue::Table(table) => Given::Table(table),
        };
        Reader { value: given, place: value.span() }
    }

    /// That this value is not what is expected.
    #[cold]
    fn misfit(&self, expected: &dyn Expected) -> Misfit {
        let found = match &self.value {
            Given::Text(text) => Unexpected::Str(text),
            Given::Integer(number) => return integer_misfit(number, expected).within(&self.place),
            Given::Real(number) => match real(number) {
                Ok(number) => Unexpected::Float(number),
                Err(misfit) => return misfit.within(&self.place),
            },
            Given::Truth(truth) => Unexpected::Bool(*truth),
            Given::Date => Unexpected::Other("date"),
            Given::Array(_) => Unexpected::Seq,
            Given::Table(_) => Unexpected::Map,
        };
        Misfit::invalid_type(found, expected).within(&self.place)
    }
}

/// An integer in the smallest of the types that can hold it.
enum Whole {
    Signed(i64),
    Unsigned(u64),
    /// With the name of the type that holds it.
    Large(String, &'static str),
    TooLarge,
}

fn whole(number: &DeInteger) -> Whole {
    let (digits, radix) = (number.as_str(), number.radix());
    if let Ok(number) = i64::from_str_radix(digits, radix) {
        Whole::Signed(number)
    } else if let Ok(number) = u64::from_str_radix(digits, radix) {
        Whole::Unsigned(number)
    } else if let Ok(number) = i128::from_str_radix(digits, radix) {
        Whole::Large(number.to_string(), "i128")
    } else if let Ok(number) = u128::from_str_radix(digits, radix) {
        Whole::Large(number.to_string(), "u128")
    } else {
        Whole::TooLarge
    }
}

#[cold]
fn integer_misfit(number: &DeInteger, expected: &dyn Expected) -> Misfit {
    match whole(number) {
        Whole::Signed(number) => Misfit::invalid_type(Unexpected::Signed(number), expected),
        Whole::Unsigned(number) => Misfit::invalid_type(Unexpected::Unsigned(number), expected),
        Whole::Large(number, kind) => {
            let named = format!("integer `{number}` as {kind}");
            Misfit::invalid_type(Unexpected::Other(&named), expected)
        }
        Whole::TooLarge => Misfit::custom("integer number overflowed"),
    }
}

/// A number that is written as infinite is that; one that is too large for its 64 bits is none.
fn real(number: &DeFloat) -> Result<f64, Misfit> {
    match number.as_str().parse::<f64>() {
        Ok(read) if !read.is_infinite() || number.as_str().contains("inf") => Ok(read),
        _ => Err(Misfit::custom("floating-point number overflowed")),
    }
}

impl<'de> Deserializer<'de> for Reader<'_> {
    type Error = Misfit;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misfit> {
        let place = self.place.clone();
        let read = match self.value {
            Given::Text(text) => visitor.visit_str(text),
            Given::Integer(number) => match whole(number) {
                Whole::Signed(number) => visitor.visit_i64(number),
                Whole::Unsigned(number) => visitor.visit_u64(number),
                // None of the types of a problem holds more than 64 bits.
                Whole::Large(..) | Whole::TooLarge => Err(integer_misfit(number, &visitor)),
            },
            Given::Real(number) => real(number).and_then(|number| visitor.visit_f64(number)),
            Given::Truth(truth) => visitor.visit_bool(truth),
            Given::Date => Err(Misfit::invalid_type(Unexpected::Other("date"), &visitor)),
            Given::Array(values) => visitor.visit_seq(Values(values.iter())),
            Given::Table(table) => visitor.visit_map(Table { rest: table.iter(), value: None }),
        };
        read.map_err(|misfit| misfit.within(&place))
    }

    /// TOML has no empty values: an option is there, or its key is not.
    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misfit> {
        let place = self.place.clone();
        visitor.visit_some(self).map_err(|misfit| misfit.within(&place))
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Misfit> {
        let place = self.place.clone();
        visitor.visit_newtype_struct(self).map_err(|misfit| misfit.within(&place))
    }

    /// Only what derived visitors of structs read, a table or the fields in their order, is tried: every further attempt is code for each struct.
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Misfit> {
        let read = match self.value {
            Given::Table(table) => visitor.visit_map(Table { rest: table.iter(), value: None }),
            Given::Array(values) => visitor.visit_seq(Values(values.iter())),
            _ => return Err(self.misfit(&visitor)),
        };
        read.map_err(|misfit| misfit.within(&self.place))
    }

    /// A name alone is a variant without settings, a table of one key a variant with them.
    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Misfit> {
        let place = self.place;
        let read = match self.value {
            Given::Text(name) => visitor.visit_enum(Variant { name, place: None, settings: None }),
            Given::Table(table) => only(table, &place).and_then(|(key, value)| {
                let (name, settings) = (&**key.get_ref(), Some(Reader::of(value)));
                visitor.visit_enum(Variant { name, place: Some(key.span()), settings })
            }),
            _ => Err(Misfit::custom("wanted string or table")),
        };
        read.map_err(|misfit| misfit.within(&place))
    }

    /// Tables that a type does not describe are not looked at.
    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misfit> {
        visitor.visit_unit()
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map identifier
    }
}

type Entry<'t> = (&'t Spanned<DeString<'t>>, &'t Spanned<DeValue<'t>>);

/// The only entry of a table.
fn only<'t>(table: &'t DeTable<'t>, place: &Range<usize>) -> Result<Entry<'t>, Misfit> {
    let mut entries = table.iter();
    match (entries.next(), entries.next()) {
        (Some(entry), None) => Ok(entry),
        (None, _) => Err("wanted exactly 1 element, found 0 elements"),
        (Some(_), Some(_)) => Err("wanted exactly 1 element, more than 1 element"),
    }
    .map_err(|message| Misfit::at(place.clone(), message.to_owned()))
}

/// The values of an array, one after the other.
struct Values<'t>(std::slice::Iter<'t, Spanned<DeValue<'t>>>);

impl<'de> SeqAccess<'de> for Values<'_> {
    type Error = Misfit;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Misfit> {
        self.0.next().map(|value| seed.deserialize(Reader::of(value))).transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

/// The entries of a table, one after the other: a key, then its value.
struct Table<'t> {
    rest: Entries<'t>,
    value: Option<&'t Spanned<DeValue<'t>>>,
}

impl<'de> MapAccess<'de> for Table<'_> {
    type Error = Misfit;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Misfit> {
        let Some((key, value)) = self.rest.next() else { return Ok(None) };
        self.value = Some(value);
        read_name(key.get_ref(), seed).map(Some).map_err(|misfit| misfit.within(&key.span()))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Misfit> {
        let Some(value) = self.value.take() else {
            return Err(Misfit::custom("a key without a value"));
        };
        seed.deserialize(Reader::of(value)).map_err(|misfit| misfit.within(&value.span()))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

/// Reads a key, or the name of a variant.
fn read_name<'de, T: DeserializeSeed<'de>>(name: &str, seed: T) -> Result<T::Value, Misfit> {
    let reader: StrDeserializer<Misfit> = name.into_deserializer();
    seed.deserialize(reader)
}

/// A variant: its name, and its settings if it stands as a table of one key.
struct Variant<'t> {
    name: &'t str,
    /// Of the key.
    place: Option<Range<usize>>,
    settings: Option<Reader<'t>>,
}

impl<'de, 't> EnumAccess<'de> for Variant<'t> {
    type Error = Misfit;
    type Variant = Settings<'t>;

    fn variant_seed<V: DeserializeSeed<'de>>(
        self,
        seed: V,
    ) -> Result<(V::Value, Settings<'t>), Misfit> {
        match (read_name(self.name, seed), &self.place) {
            (Ok(variant), _) => Ok((variant, Settings(self.settings))),
            (Err(misfit), Some(place)) => Err(misfit.within(place)),
            (Err(misfit), None) => Err(misfit),
        }
    }
}

/// The settings of a variant, if it has any.
struct Settings<'t>(Option<Reader<'t>>);

impl<'t> Settings<'t> {
    fn of(self, kind: &'static str) -> Result<Reader<'t>, Misfit> {
        self.0.ok_or_else(|| Misfit::invalid_type(Unexpected::UnitVariant, &kind))
    }
}

impl<'de> VariantAccess<'de> for Settings<'_> {
    type Error = Misfit;

    fn unit_variant(self) -> Result<(), Misfit> {
        let Some(Reader { value, place }) = self.0 else { return Ok(()) };
        let message = match value {
            Given::Array([]) => return Ok(()),
            Given::Table(table) if table.is_empty() => return Ok(()),
            Given::Array(_) => "expected empty array",
            Given::Table(_) => "expected empty table",
            Given::Text(_) => "expected table, found string",
            Given::Integer(_) => "expected table, found integer",
            Given::Real(_) => "expected table, found float",
            Given::Truth(_) => "expected table, found boolean",
            Given::Date => "expected table, found datetime",
        };
        Err(Misfit::at(place, message.to_owned()))
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Misfit> {
        seed.deserialize(self.of("newtype variant")?)
    }

    fn tuple_variant<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Misfit> {
        let reader = self.of("tuple variant")?;
        match reader.value {
            Given::Array(values) if values.len() == length => {
                visitor.visit_seq(Values(values.iter()))
            }
            _ => Err(Misfit::at(reader.place, format!("expected tuple with length {length}"))),
        }
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Misfit> {
        let reader = self.of("struct variant")?;
        if let Given::Table(table) = reader.value {
            known_keys(table, fields)?;
        }
        reader.deserialize_struct("", fields, visitor)
    }
}

/// That the table has no keys but these.
fn known_keys(table: &DeTable, fields: &[&str]) -> Result<(), Misfit> {
    let is_unknown = |key: &&Spanned<DeString>| !fields.contains(&&**key.get_ref());
    let unknown: Vec<&Spanned<DeString>> = table.keys().filter(is_unknown).collect();
    let Some(first) = unknown.first() else { return Ok(()) };
    let names: Vec<&str> = unknown.iter().map(|key| &**key.get_ref()).collect();
    let (found, expected) = (names.join(", "), fields.join(", "));
    let message = format!("unexpected keys in table: {found}, available keys: {expected}");
    Err(Misfit::at(first.span(), message))
}
