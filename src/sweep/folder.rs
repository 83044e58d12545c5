//! The folder of a study: a line for each case that ended, and the tables made of them.
//!
//! A process appends to one file, `cases.jsonl`, or `cases_2of8.jsonl` for a share, and reads all of them: shares may
//! run side by side in one folder. A line without its end was being written when a process ended, and is dropped.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::cases::{Case, Share};
use super::error::SweepError;
use super::means::Means;
use super::outcome::Outcome;
use super::picture::picture;
use super::study::{PlotTable, Study};
use super::tables::{runs_table, steps_table};
use crate::output::{FolderLock, GrowingTable, OutputError, difference, write_atomically};

/// Marks the folder as that of a study.
const MARKER: &str = "study.json";
/// Beginning and end of the names of files of cases.
const CASES: [&str; 2] = ["cases", ".jsonl"];
/// The means and their pictures.
const MEANS: [&str; 3] = ["means.csv", "means.png", "means.svg"];

#[derive(Debug, Serialize, Deserialize)]
struct Marker {
    tabor: String,
    study: String,
}

/// The folder of a study, held by this process for one share.
#[derive(Debug)]
pub struct SweepFolder {
    path: PathBuf,
    table: GrowingTable,
    lock: FolderLock,
    /// Cases that ended, by their number.
    outcomes: BTreeMap<usize, Outcome>,
}

impl SweepFolder {
    /// Opens a folder for a study, or for a share of it, and reads the cases that ended.
    ///
    /// # Errors
    /// A folder of another study or of something else; another process that runs the same share.
    pub fn open(
        path: &Path,
        study: &Study,
        share: Option<Share>,
    ) -> Result<SweepFolder, SweepError> {
        if path.is_file() {
            return Err(OutputError::refused(path, "is a file; name a folder").into());
        }
        fs::create_dir_all(path).map_err(OutputError::write("create the folder", path))?;
        mark(path, study)?;
        let stem = match share {
            None => CASES[0].to_owned(),
            Some(Share { number, of }) => format!("{}_{number}of{of}", CASES[0]),
        };
        let lock = FolderLock::take(&path.join(format!(".{stem}.lock")), path)?;
        let own = path.join(format!("{stem}{}", CASES[1]));
        let mut outcomes = BTreeMap::new();
        let mut text = String::new();
        for file in case_files(path)? {
            for (line, outcome) in read_lines(&file)? {
                if file == own {
                    text.push_str(&line);
                }
                add(&mut outcomes, outcome);
            }
        }
        Ok(SweepFolder {
            table: GrowingTable::create(&own, text)?,
            path: path.to_path_buf(),
            lock,
            outcomes,
        })
    }

    /// The warning of a folder that cannot be locked.
    pub fn warning(&self) -> Option<&str> {
        self.lock.warning()
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Cases that ended, in their order.
    pub fn outcomes(&self) -> impl Iterator<Item = &Outcome> {
        self.outcomes.values()
    }

    /// Whether a case is finished; one that failed is solved again.
    pub fn has(&self, number: usize) -> bool {
        self.outcomes.get(&number).is_some_and(Outcome::is_finished)
    }

    /// Keeps a case that ended: the system has it when this returns, so that it outlives this process, and the disk
    /// with the next [`sync`](Self::sync).
    ///
    /// # Errors
    /// What the system says.
    pub fn keep(&mut self, outcome: Outcome) -> Result<(), SweepError> {
        self.table.hand_over(&json_line(&outcome))?;
        add(&mut self.outcomes, outcome);
        Ok(())
    }

    /// A warning of cases, those `own`, that were finished before the study asked for their folders.
    pub fn without_folder(&self, study: &Study, own: impl Fn(usize) -> bool) -> Option<String> {
        let lacks = |case: &Case| {
            own(case.number)
                && study.keeps(case)
                && self.has(case.number)
                && !case_folder(&self.path, case.number).exists()
        };
        let lacking: Vec<usize> = study
            .cases()
            .filter(lacks)
            .map(|case| case.number)
            .collect();
        let first = lacking.first()?;
        Some(format!(
            "folders: {} of the cases that were finished before have none, the first of them case {first}, and are not solved again: name another folder for the study",
            lacking.len()
        ))
    }

    /// Waits until all cases that are kept are on the disk.
    ///
    /// # Errors
    /// What the system says.
    pub fn sync(&self) -> Result<(), SweepError> {
        Ok(self.table.sync()?)
    }

    /// Adds the cases of another folder of the same study.
    ///
    /// # Errors
    /// A folder that is not this study's, or cannot be read.
    pub fn merge(&mut self, other: &Path, study: &Study) -> Result<(), SweepError> {
        if !other.join(MARKER).is_file() {
            let reason = "is not the folder of a study (there is no study.json)";
            return Err(OutputError::refused(other, reason).into());
        }
        expect_own(other, study)?;
        let mut lines = String::new();
        for file in case_files(other)? {
            for (line, outcome) in read_lines(&file)? {
                if !self.has(outcome.number) {
                    lines.push_str(&line);
                    add(&mut self.outcomes, outcome);
                }
            }
        }
        if !lines.is_empty() {
            self.table.append(&lines)?;
        }
        Ok(())
    }

    /// Writes `sweep.csv`, `runs.csv` and the means with their pictures. Returns a warning where the study names what is
    /// drawn, and finished cases do not have it.
    ///
    /// # Errors
    /// What the system says.
    pub fn write_tables(&self, study: &Study) -> Result<Option<String>, SweepError> {
        let outcomes: Vec<&Outcome> = self.outcomes().collect();
        let keys: Vec<&str> = study.keys().collect();
        let write =
            |name: &str, text: String| write_atomically(&self.path.join(name), text.as_bytes());
        write("sweep.csv", steps_table(&keys, &outcomes))?;
        write("runs.csv", runs_table(&keys, &outcomes))?;
        let is_asked =
            study.plot != PlotTable::default() && outcomes.iter().any(|it| it.is_finished());
        match Means::new(study, &outcomes) {
            Ok(means) => {
                write("means.csv", means.table())?;
                picture(study, &means).write(&self.path.join("means.png"))?;
                let cases = [
                    (
                        "plot.x: ",
                        format!("a number at {}", means.x),
                        means.left_out,
                    ),
                    ("", means.quantity.clone(), means.lacking),
                ];
                let some = cases.iter().filter(|(_, _, count)| *count > 0);
                let warnings: Vec<String> = some
                    .map(|(key, what, count)| {
                        format!("{key}finished cases without {what}, which are in no mean: {count}")
                    })
                    .collect();
                Ok((!warnings.is_empty()).then(|| warnings.join("; ")))
            }
            Err(missing) => {
                self.remove_means()?;
                Ok(is_asked.then(|| format!("{missing}; there are no means and no picture")))
            }
        }
    }

    /// Removes the means of an earlier call, whose `[plot]` may have been another.
    fn remove_means(&self) -> Result<(), OutputError> {
        for name in MEANS {
            let path = self.path.join(name);
            match fs::remove_file(&path) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => {
                    return Err(OutputError::write("remove", &path)(error));
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// The folder of a case whose folder is kept.
pub(super) fn case_folder(path: &Path, number: usize) -> PathBuf {
    path.join(format!("case_{number:04}"))
}

/// Adds a case that ended; a finished one stays.
fn add(outcomes: &mut BTreeMap<usize, Outcome>, outcome: Outcome) {
    let is_finished = outcomes
        .get(&outcome.number)
        .is_some_and(Outcome::is_finished);
    if !is_finished {
        outcomes.insert(outcome.number, outcome);
    }
}

/// A value as a line of JSON.
fn json_line(value: &impl Serialize) -> String {
    // Numbers, texts and lists can always be written as JSON; what is not finite becomes null.
    serde_json::to_string(value).unwrap_or_default() + "\n"
}

/// Marks a folder as that of this study, unless it is marked. Processes that begin together do it one by one.
fn mark(path: &Path, study: &Study) -> Result<(), OutputError> {
    let _lock = FolderLock::wait(&path.join(FolderLock::HIDDEN), path)?;
    if expect_own(path, study)? {
        return Ok(());
    }
    let marker = Marker {
        tabor: env!("CARGO_PKG_VERSION").to_owned(),
        study: study.fingerprint().to_owned(),
    };
    write_atomically(&path.join(MARKER), json_line(&marker).as_bytes())
}

/// Refuses a folder that holds another study, or files of something else; whether it is marked as this study's.
fn expect_own(path: &Path, study: &Study) -> Result<bool, OutputError> {
    let bytes = match fs::read(path.join(MARKER)) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            let mut entries =
                fs::read_dir(path).map_err(OutputError::write("read the folder", path))?;
            // A process that ended before it marked the folder leaves hidden files.
            let is_other = entries.any(|entry| {
                entry.is_ok_and(|entry| !entry.file_name().to_string_lossy().starts_with('.'))
            });
            if is_other {
                return Err(OutputError::refused(
                    path,
                    "holds files that tabor sweep did not write (there is no study.json); name an empty or new folder",
                ));
            }
            return Ok(false);
        }
        Err(error) => return Err(OutputError::write("read", &path.join(MARKER))(error)),
    };
    match serde_json::from_slice::<Marker>(&bytes) {
        Ok(marker) if marker.study == study.fingerprint() => Ok(true),
        Ok(marker) => Err(OutputError::refused(
            path,
            format!(
                "holds the results of another study{}; name another folder, or move this one away",
                difference(&marker.study, study.fingerprint())
            ),
        )),
        Err(_) => Err(OutputError::refused(
            path,
            "has a study.json that is damaged; name another folder",
        )),
    }
}

/// The files of cases in a folder, in the order of their names.
fn case_files(path: &Path) -> Result<Vec<PathBuf>, OutputError> {
    let unreadable = || OutputError::write("read the folder", path);
    let mut files = Vec::new();
    for entry in fs::read_dir(path).map_err(unreadable())? {
        let entry = entry.map_err(unreadable())?;
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if name.starts_with(CASES[0]) && name.ends_with(CASES[1]) {
            files.push(entry.path());
        }
    }
    files.sort();
    Ok(files)
}

/// The whole lines of a file of cases.
fn read_lines(path: &Path) -> Result<Vec<(String, Outcome)>, OutputError> {
    let bytes = fs::read(path).map_err(OutputError::write("read", path))?;
    let text = String::from_utf8_lossy(&bytes);
    let whole = text
        .split_inclusive('\n')
        .filter(|line| line.ends_with('\n'));
    whole
        .enumerate()
        .map(|(index, line)| {
            let outcome = serde_json::from_str(line).map_err(|error| {
                let reason = format!(
                    "line {} is not a case that tabor sweep wrote ({error}); remove that line, and the case is solved again",
                    index + 1
                );
                OutputError::refused(path, reason)
            })?;
            Ok((line.to_owned(), outcome))
        })
        .collect()
}
