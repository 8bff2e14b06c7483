//! A session that is asked in JSON.

use hysteron_studio::{Fault, Response, Session};
use serde_json::{Value, json};

/// The answer in JSON: the id of a fit that was made, the bytes that were taken, or the response.
pub fn ask(session: &mut Session, request: Value) -> Result<Value, Fault> {
    let answer = session.handle(serde_json::from_value(request).unwrap())?;
    if let Some(job) = answer.job {
        return Ok(json!(session.finish(job.run())?));
    }
    if let Response::Taken(taken) = answer.response {
        return Ok(json!({ "bytes": taken.bytes }));
    }
    Ok(serde_json::to_value(answer.response).unwrap())
}
