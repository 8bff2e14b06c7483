//! Numbers and labels in the columns of Arrow.

use crate::data::table::labels::Labels;
use arrow_array::cast::AsArray;
use arrow_array::types::{
    ArrowPrimitiveType, Decimal32Type, Decimal64Type, Decimal128Type, Float16Type, Float32Type,
    Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, UInt8Type, UInt16Type, UInt32Type,
    UInt64Type,
};
use arrow_array::{Array, ArrayRef, make_array};
use arrow_schema::{ArrowError, DataType, TimeUnit};

/// A time in seconds is so many times the stored number, or that number divided by so many.
#[derive(Clone, Copy)]
enum Seconds {
    Times(f64),
    In(f64),
}

/// How times of this type are stored; `None` for other types.
fn seconds(of: &DataType) -> Option<Seconds> {
    Some(match of {
        DataType::Date32 => Seconds::Times(86_400.0),
        DataType::Date64 => Seconds::In(1e3),
        DataType::Timestamp(unit, _)
        | DataType::Time32(unit)
        | DataType::Time64(unit)
        | DataType::Duration(unit) => Seconds::In(match unit {
            TimeUnit::Second => 1.0,
            TimeUnit::Millisecond => 1e3,
            TimeUnit::Microsecond => 1e6,
            TimeUnit::Nanosecond => 1e9,
        }),
        _ => return None,
    })
}

pub(super) fn is_time(of: &DataType) -> bool {
    seconds(of).is_some()
}

/// Whether a column of this type has a number in each row.
pub(super) fn is_number(of: &DataType) -> bool {
    match of {
        DataType::Dictionary(_, values) => is_number(values),
        DataType::Null
        | DataType::Boolean
        | DataType::Decimal32(..)
        | DataType::Decimal64(..)
        | DataType::Decimal128(..) => true,
        other => is_time(other) || other.is_integer() || other.is_floating(),
    }
}

/// The numbers of a column for which [`is_number`] holds, NaN for null. Times are in seconds.
pub(super) fn numbers(array: &dyn Array) -> Result<Vec<f64>, ArrowError> {
    if let Some(dictionary) = array.as_any_dictionary_opt() {
        let values = numbers(dictionary.values().as_ref())?;
        return Ok(by_key(array, &values));
    }
    let decimal = |scale: i8| 10_f64.powi(i32::from(scale));
    Ok(match array.data_type() {
        DataType::Boolean => {
            let number = |on: Option<bool>| on.map_or(f64::NAN, |on| f64::from(u8::from(on)));
            array.as_boolean().iter().map(number).collect()
        }
        DataType::Int8 => of::<Int8Type>(array, f64::from),
        DataType::Int16 => of::<Int16Type>(array, f64::from),
        DataType::Int32 => of::<Int32Type>(array, f64::from),
        DataType::Int64 => of::<Int64Type>(array, |v| v as f64),
        DataType::UInt8 => of::<UInt8Type>(array, f64::from),
        DataType::UInt16 => of::<UInt16Type>(array, f64::from),
        DataType::UInt32 => of::<UInt32Type>(array, f64::from),
        DataType::UInt64 => of::<UInt64Type>(array, |v| v as f64),
        DataType::Float16 => of::<Float16Type>(array, f64::from),
        DataType::Float32 => of::<Float32Type>(array, f64::from),
        DataType::Float64 => of::<Float64Type>(array, |v| v),
        DataType::Decimal32(_, scale) => {
            let unit = decimal(*scale);
            of::<Decimal32Type>(array, |v| f64::from(v) / unit)
        }
        DataType::Decimal64(_, scale) => {
            let unit = decimal(*scale);
            of::<Decimal64Type>(array, |v| v as f64 / unit)
        }
        DataType::Decimal128(_, scale) => {
            let unit = decimal(*scale);
            of::<Decimal128Type>(array, |v| v as f64 / unit)
        }
        time => match seconds(time) {
            None => vec![f64::NAN; array.len()],
            Some(unit) => {
                let mut stored = numbers(stored(array)?.as_ref())?;
                for value in &mut stored {
                    *value = match unit {
                        Seconds::Times(factor) => *value * factor,
                        Seconds::In(divisor) => *value / divisor,
                    };
                }
                stored
            }
        },
    })
}

/// The labels of a column of any type, as codes; NaN for null.
pub(super) fn codes(array: &dyn Array, labels: &Labels) -> Result<Vec<f64>, ArrowError> {
    if let Some(dictionary) = array.as_any_dictionary_opt() {
        let values = codes(dictionary.values().as_ref(), labels)?;
        return Ok(by_key(array, &values));
    }
    let code = |label: Option<&[u8]>| label.map_or(f64::NAN, |label| labels.code(label));
    let text = |label: Option<&str>| code(label.map(str::as_bytes));
    let shown = |value: f64| match value.is_nan() {
        true => f64::NAN,
        false => labels.code(value.to_string().as_bytes()),
    };
    Ok(match array.data_type() {
        DataType::Utf8 => array.as_string::<i32>().iter().map(text).collect(),
        DataType::LargeUtf8 => array.as_string::<i64>().iter().map(text).collect(),
        DataType::Utf8View => array.as_string_view().iter().map(text).collect(),
        DataType::Binary => array.as_binary::<i32>().iter().map(code).collect(),
        DataType::LargeBinary => array.as_binary::<i64>().iter().map(code).collect(),
        DataType::BinaryView => array.as_binary_view().iter().map(code).collect(),
        DataType::FixedSizeBinary(_) => array.as_fixed_size_binary().iter().map(code).collect(),
        DataType::Boolean => {
            let shown = |on: Option<bool>| text(on.map(|on| if on { "true" } else { "false" }));
            array.as_boolean().iter().map(shown).collect()
        }
        // A double does not hold all of them.
        DataType::Int64 => of::<Int64Type>(array, |v| labels.code(v.to_string().as_bytes())),
        DataType::UInt64 => of::<UInt64Type>(array, |v| labels.code(v.to_string().as_bytes())),
        DataType::Float32 => of::<Float32Type>(array, |v| labels.code(v.to_string().as_bytes())),
        time if is_time(time) => codes(stored(array)?.as_ref(), labels)?,
        _ => numbers(array)?.into_iter().map(shown).collect(),
    })
}

/// The value of each row by the keys of a dictionary, NaN for null.
fn by_key(array: &dyn Array, values: &[f64]) -> Vec<f64> {
    // Without values, all keys are null.
    if values.is_empty() {
        return vec![f64::NAN; array.len()];
    }
    let keys = array.as_any_dictionary().normalized_keys();
    let value = |(row, key): (usize, &usize)| match array.is_null(row) {
        true => f64::NAN,
        false => values.get(*key).copied().unwrap_or(f64::NAN),
    };
    keys.iter().enumerate().map(value).collect()
}

fn of<T: ArrowPrimitiveType>(array: &dyn Array, number: impl Fn(T::Native) -> f64) -> Vec<f64> {
    let array = array.as_primitive::<T>();
    match array.null_count() {
        0 => array.values().iter().map(|value| number(*value)).collect(),
        _ => {
            let cells = array.iter();
            cells.map(|cell| cell.map_or(f64::NAN, &number)).collect()
        }
    }
}

/// Times as the whole numbers that are stored.
fn stored(array: &dyn Array) -> Result<ArrayRef, ArrowError> {
    let integer = match array.data_type().primitive_width() {
        Some(4) => DataType::Int32,
        _ => DataType::Int64,
    };
    let data = array.to_data().into_builder().data_type(integer);
    Ok(make_array(data.build()?))
}
