//! Tests of the state after a step.

use super::*;

fn state(single: bool) -> SavedState<'static> {
    let values = vec![0.1, -0.0, f64::MIN_POSITIVE, 1e300, f64::INFINITY];
    let values = if single {
        values.iter().map(|v| f64::from(*v as f32)).collect()
    } else {
        values
    };
    SavedState {
        scene: "a \"scene\"".into(),
        solver: serde_json::json!({ "tolerance": 1e-6 }),
        machine: "cpu, double".into(),
        finished: 3,
        curve: 0xdead_beef,
        warnings: vec!["step 2 is separated".into()],
        single,
        checkpoint: Cow::Owned(Checkpoint {
            fields: vec![CheckpointField {
                name: "gap".into(),
                values: Arc::new(values.into()),
            }],
            evaluated_under: Some(0.1),
            points: Some(vec![
                PointState::Contact,
                PointState::Separated,
                PointState::Attracted,
            ]),
            jump_in_steps: vec![2],
            jump_off_steps: vec![],
            pull_off: Some(PullOff {
                step: 2,
                lower: 0.1,
                upper: 0.1 + f64::EPSILON,
            }),
            transforms: 1234.5625,
        }),
    }
}

fn decode(bytes: &[u8]) -> Result<SavedState<'static>, String> {
    let read = StateFile::check(Cursor::new(bytes), Path::new("state"));
    let read = read.and_then(StateFile::read_all);
    read.map_err(|error| error.to_string())
}

fn bytes_of(state: &SavedState) -> Vec<u8> {
    let mut bytes = Vec::new();
    state.encode(&mut bytes, None).unwrap();
    bytes
}

#[test]
fn states_come_back_bit_for_bit() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("state/last_step.bin");
    assert_eq!(SavedState::read(&path).unwrap(), None);
    for single in [false, true] {
        let state = state(single);
        state.write(&path).unwrap();
        let read = SavedState::read(&path).unwrap().unwrap();
        let bits = |state: &SavedState| -> Vec<u64> {
            let values = state.checkpoint.fields[0].values.iter();
            values.map(|value| value.to_bits()).collect()
        };
        assert_eq!(bits(&read), bits(&state));
        assert_eq!(read, state);
    }
}

#[test]
fn every_cut_and_every_flipped_bit_is_noticed() {
    let bytes = bytes_of(&state(false));
    assert!(decode(&bytes).is_ok());
    for end in 0..bytes.len() {
        assert!(decode(&bytes[..end]).is_err(), "cut at {end}");
    }
    for at in 0..bytes.len() {
        let mut flipped = bytes.clone();
        flipped[at] ^= 1 << (at % 8);
        assert!(decode(&flipped).is_err(), "flipped at {at}");
    }
    let mut longer = bytes;
    longer.push(0);
    assert!(decode(&longer).is_err());
}

#[test]
fn a_state_of_another_version_says_so() {
    let mut bytes = bytes_of(&state(false));
    bytes.truncate(bytes.len() - CHECKSUM_BYTES);
    let version = format!("\"tabor\":\"{}\"", env!("CARGO_PKG_VERSION"));
    let at = bytes
        .windows(version.len())
        .position(|window| window == version.as_bytes())
        .unwrap();
    bytes[at + 9] = b'7';
    bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
    let reason = decode(&bytes).unwrap_err();
    assert!(reason.contains("written by tabor 7"), "{reason}");
    // Well formed, but announcing more than the file holds: no allocation of that size.
    let mut huge = bytes_of(&state(false));
    huge.truncate(huge.len() - CHECKSUM_BYTES);
    let text = b"[\"gap\",5]";
    let at = huge.windows(text.len()).position(|w| w == text).unwrap();
    huge.splice(at..at + text.len(), *b"[\"gap\",4611686018427387904]");
    let grown = 18;
    let length = u64::from_le_bytes(huge[FORM.len()..FORM.len() + 8].try_into().unwrap());
    huge[FORM.len()..FORM.len() + 8].copy_from_slice(&(length + grown).to_le_bytes());
    huge.extend(crc32fast::hash(&huge).to_le_bytes());
    assert!(decode(&huge).unwrap_err().contains("damaged"));
}
