//! Names that a model may have in C.

use hysteron::{Error, Remedy, Result, Setting};
use std::path::Path;

/// As many letters of an external name as C99 tells apart (5.2.4.1).
const LONGEST: usize = 31;

/// Words of C and C++, and what C99 reserves (7.1.3): a global object of that name does not compile
/// or replaces a function.
const TAKEN: &str = "auto break case char const continue default do double else enum extern float \
                     for goto if inline int long register restrict return short signed sizeof \
                     static struct switch typedef union unsigned void volatile while alignas \
                     alignof and and_eq asm bitand bitor bool catch class compl concept const_cast \
                     constexpr constinit consteval decltype delete dynamic_cast explicit export \
                     false friend mutable namespace new noexcept not not_eq nullptr operator or \
                     or_eq private protected public reinterpret_cast requires static_assert \
                     static_cast template this thread_local throw true try typeid typename typeof \
                     using virtual wchar_t xor xor_eq linux unix near far interrupt main errno \
                     size_t ptrdiff_t table offsetof assert signal raise setjmp longjmp setlocale \
                     localeconv isalnum isalpha isblank iscntrl isdigit isgraph islower isprint \
                     ispunct isspace isupper isxdigit tolower toupper acos asin atan atan2 cos sin \
                     tan acosh asinh atanh cosh sinh tanh exp exp2 expm1 frexp ilogb ldexp log \
                     log10 log1p log2 logb modf scalbn scalbln cbrt fabs hypot pow sqrt erf erfc \
                     gamma lgamma tgamma ceil floor nearbyint rint lrint llrint round lround \
                     llround trunc fmod remainder remquo copysign nan nextafter nexttoward fdim \
                     fmax fmin fma j0 j1 jn y0 y1 yn finite drem significand scalb exp10 pow10 ffs \
                     index rindex bcmp bcopy bzero alloca cabs carg cimag creal conj cproj cacos \
                     casin catan ccos csin ctan cexp clog cpow csqrt remove rename tmpfile tmpnam \
                     fclose fflush fopen freopen setbuf setvbuf fprintf fscanf printf scanf \
                     snprintf sprintf sscanf vfprintf vfscanf vprintf vscanf vsnprintf vsprintf \
                     vsscanf fgetc fgets fputc fputs getc getchar gets putc putchar puts ungetc \
                     fread fwrite fgetpos fseek fsetpos ftell rewind clearerr feof ferror perror \
                     stdin stdout stderr atof atoi atol atoll strtod strtof strtold strtol strtoll \
                     strtoul strtoull rand srand calloc free malloc realloc abort atexit exit \
                     getenv system bsearch qsort abs labs llabs div ldiv lldiv mblen mbtowc wctomb \
                     mbstowcs wcstombs memcpy memmove strcpy strncpy strcat strncat memcmp strcmp \
                     strcoll strncmp strxfrm memchr strchr strcspn strpbrk strrchr strspn strstr \
                     strtok memset strerror strlen clock difftime mktime time asctime ctime gmtime \
                     localtime strftime";

/// The name that was asked for, or one after the model's file.
pub(super) fn choose(asked: Option<&str>, source: &Path) -> Result<String> {
    let name = match asked {
        Some(name) => name.to_owned(),
        None => after(&source.file_stem().unwrap_or_default().to_string_lossy()),
    };
    match fault(&name) {
        None => Ok(name),
        Some(why) => {
            let what = format!("`{name}` cannot be the model's name in C: {why}");
            let remedy = Remedy::new("choose one with {}", [Setting::any("name")]);
            Err(Error::Export(what).remedied(remedy))
        }
    }
}

fn fault(name: &str) -> Option<&'static str> {
    let letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let lower = name.to_ascii_lowercase();
    if !name.starts_with(|c: char| c.is_ascii_alphabetic()) || !name.chars().all(letter) {
        Some("it has to be of letters A to Z, digits and _, and to begin with a letter")
    } else if name.len() > LONGEST {
        Some("it has more than 31 letters")
    } else if lower.starts_with("hys_") || lower.starts_with("hysteron_mcu") {
        Some("hys_ and hysteron_mcu are names of the algorithm")
    } else if HEADERS.iter().any(|end| name.ends_with(end)) {
        Some("names that end with _t, _MAX or _MIN are those of C's headers")
    } else if is_taken(name) || is_of_headers(name) {
        Some("it is a word of C or C++ or a name of its library")
    } else if crate::device::is_device(name) {
        Some(crate::device::DEVICE)
    } else {
        None
    }
}

fn is_taken(name: &str) -> bool {
    // Functions of math.h have a sister for float and one for long double.
    let sister = name.strip_suffix(['f', 'l']).unwrap_or(name);
    TAKEN
        .split_whitespace()
        .any(|word| word == name || word == sister)
}

/// Types and macros of the headers that `hysteron_mcu.h` includes, and what C99 reserves for more
/// of them (7.26.8).
fn is_of_headers(name: &str) -> bool {
    let begins = |starts: &[&str]| starts.iter().any(|start| name.starts_with(start));
    ["NULL", "DECIMAL_DIG"].contains(&name)
        || begins(&["FLT_", "DBL_", "LDBL_"])
        || begins(&["INT", "UINT"]) && name.ends_with("_C")
}

/// What the types and limits of headers end with.
const HEADERS: [&str; 3] = ["_t", "_MAX", "_MIN"];

/// What makes a name of one that C has.
const OWN: &str = "model";

/// A name made of a file's: what is no letter becomes `_`.
fn after(stem: &str) -> String {
    let letters = stem.chars().map(|c| match c {
        c if c.is_ascii_alphanumeric() => c,
        _ => '_',
    });
    let mut name: String = letters.collect();
    if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        name = format!("{OWN}_{name}");
    }
    name.truncate(LONGEST);
    let short = &name[..name.len().min(LONGEST - OWN.len() - 1)];
    let both = &name[..name.len().min(LONGEST - 2 * (OWN.len() + 1))];
    let names = [
        format!("{OWN}_{short}"),
        format!("{short}_{OWN}"),
        format!("{OWN}_{both}_{OWN}"),
    ];
    match fault(&name) {
        None => name,
        Some(_) => names
            .into_iter()
            .find(|name| fault(name).is_none())
            .unwrap_or(name),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_file_gives_its_name() {
        let cases = [
            ("spring.json", "spring"),
            ("my spring (2).json", "my_spring__2_"),
            ("7 mm.json", "model_7_mm"),
            ("Länge.json", "L_nge"),
            ("double.json", "model_double"),
            ("sinf.json", "model_sinf"),
            ("hys_x.json", "model_hys_x"),
            ("hysteron_mcu.json", "model_hysteron_mcu"),
            ("_x.json", "model__x"),
            (".json", "model__json"),
            ("..", "model_"),
            ("aux.json", "model_aux"),
            ("NULL.json", "model_NULL"),
            ("wire-t.json", "wire_t_model"),
            ("range_MAX.json", "range_MAX_model"),
            ("hys_x_t.json", "model_hys_x_t_model"),
        ];
        for (file, name) in cases {
            assert_eq!(choose(None, Path::new(file)).unwrap(), name, "{file}");
        }
        let long = "a".repeat(60) + ".json";
        assert_eq!(choose(None, Path::new(&long)).unwrap(), "a".repeat(31));
    }

    #[test]
    fn names_that_c_does_not_take_are_refused() {
        let long = "a".repeat(32);
        let bad = [
            "",
            "7",
            "_x",
            "a b",
            "a-b",
            "ä",
            "int",
            "class",
            "main",
            "expf",
            "hys_x",
            "HYS_X",
            "table",
            "a;",
            "../x",
            "hysteron_mcu",
            "NULL",
            "int32_t",
            "INT8_MAX",
            "UINT64_C",
            "DBL_EPSILON",
            "SIZE_MAX",
            "con",
            "LPT1",
            &long,
        ];
        for name in bad {
            let error = choose(Some(name), Path::new("spring.json")).unwrap_err();
            assert!(
                error.to_string().contains("choose one with `name`"),
                "{name}: {error}"
            );
        }
        assert_eq!(choose(Some("left"), Path::new("x")).unwrap(), "left");
    }
}
