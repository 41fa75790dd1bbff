// The part of Unreal's API that bindings/unreal/DanceGraph calls, as far as its documented
// behaviour goes, so that the plug-in is compiled and its Live Link source runs against a client
// that keeps what it is given. Unreal itself is not here.
//
// Units/frames: none of its own.
// Ownership:    plain values.
// Threads:      FRunnableThread is a real thread; the client is guarded by its own lock.
// Failure:      none.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using int32 = std::int32_t;
using uint32 = std::uint32_t;
using TCHAR = char;
#define TEXT(text) text
#define TCHAR_TO_UTF8(text) (text)
#define UTF8_TO_TCHAR(text) (text)
#define LOCTEXT(key, text) FText::FromString(FString(text))

class FString {
 public:
  FString() = default;
  explicit FString(const char* text) : text_(text) {}
  const char* operator*() const { return text_.c_str(); }
  bool IsEmpty() const { return text_.empty(); }

 private:
  std::string text_;
};

struct FText {
  static FText FromString(const FString& string) { return {string}; }
  FString string;
};

class FName {
 public:
  FName() = default;
  explicit FName(const char* text) : text_(text) {}
  bool operator==(const FName&) const = default;
  bool operator<(const FName& other) const { return text_ < other.text_; }

 private:
  std::string text_;
};

struct FGuid {
  std::array<uint32, 4> words{};
};

template <class Item>
class TArray {
 public:
  void Add(Item item) { items_.push_back(std::move(item)); }
  int32 Num() const { return static_cast<int32>(items_.size()); }
  const Item& operator[](int32 index) const { return items_[static_cast<std::size_t>(index)]; }

 private:
  std::vector<Item> items_;
};

template <class Item>
std::remove_reference_t<Item>&& MoveTemp(Item&& item) {
  return static_cast<std::remove_reference_t<Item>&&>(item);
}
template <class Item>
using TSharedPtr = std::shared_ptr<Item>;
template <class Item, class... Arguments>
std::shared_ptr<Item> MakeShared(Arguments&&... arguments) {
  return std::make_shared<Item>(std::forward<Arguments>(arguments)...);
}

struct FVector {
  FVector(double x, double y, double z) : X(x), Y(y), Z(z) {}
  double X, Y, Z;
};
struct FQuat {
  FQuat(double x, double y, double z, double w) : X(x), Y(y), Z(z), W(w) {}
  double X, Y, Z, W;
};
struct FTransform {
  FTransform(const FQuat& rotation, const FVector& place) : Rotation(rotation), Place(place) {}
  FQuat Rotation;
  FVector Place;
};

struct FPlatformProcess {
  static void Sleep(float seconds) {
    std::this_thread::sleep_for(std::chrono::duration<float>(seconds));
  }
};
struct FPlatformTime {
  static double Seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }
};

using FThreadSafeBool = std::atomic<bool>;

class FRunnable {
 public:
  virtual ~FRunnable() = default;
  virtual uint32 Run() = 0;
  virtual void Stop() {}
};

class FRunnableThread {
 public:
  static FRunnableThread* Create(FRunnable* runnable, const TCHAR*) {
    return new FRunnableThread(runnable);
  }
  ~FRunnableThread() { Kill(true); }
  bool Kill(bool) {
    runnable_->Stop();
    if (thread_.joinable()) thread_.join();
    return true;
  }

 private:
  explicit FRunnableThread(FRunnable* runnable)
      : runnable_(runnable), thread_([runnable] { runnable->Run(); }) {}
  FRunnable* runnable_;
  std::thread thread_;
};

// Live Link: the animation role, its data, and the client that receives it.
struct UScriptStruct {};
struct FLiveLinkSkeletonStaticData {
  static UScriptStruct* StaticStruct() { return nullptr; }
  TArray<FName> BoneNames;
  TArray<int32> BoneParents;
};
struct FLiveLinkWorldTime {
  FLiveLinkWorldTime() = default;
  explicit FLiveLinkWorldTime(double seconds) : Seconds(seconds) {}
  double Seconds = 0.0;
};
struct FLiveLinkAnimationFrameData {
  static UScriptStruct* StaticStruct() { return nullptr; }
  FLiveLinkWorldTime WorldTime;
  TArray<FTransform> Transforms;
};
template <class Data>
class FLiveLinkDataStruct {
 public:
  explicit FLiveLinkDataStruct(UScriptStruct*) {}
  template <class Wanted>
  Wanted* Cast() {
    return &data;
  }
  Data data;
};
using FLiveLinkStaticDataStruct = FLiveLinkDataStruct<FLiveLinkSkeletonStaticData>;
using FLiveLinkFrameDataStruct = FLiveLinkDataStruct<FLiveLinkAnimationFrameData>;

struct FLiveLinkSubjectKey {
  FLiveLinkSubjectKey(FGuid source, FName subject) : Source(source), SubjectName(subject) {}
  FGuid Source;
  FName SubjectName;
};
struct UClass {};
struct ULiveLinkAnimationRole {
  static UClass* StaticClass() { return nullptr; }
};

class ILiveLinkClient;
class ILiveLinkSource {
 public:
  virtual ~ILiveLinkSource() = default;
  virtual void ReceiveClient(ILiveLinkClient* InClient, FGuid InSourceGuid) = 0;
  virtual bool IsSourceStillValid() const = 0;
  virtual bool RequestSourceShutdown() = 0;
  virtual FText GetSourceType() const = 0;
  virtual FText GetSourceMachineName() const = 0;
  virtual FText GetSourceStatus() const = 0;
};

class ILiveLinkClient {
 public:
  inline static const FName ModularFeatureName{"LiveLinkClient"};
  virtual ~ILiveLinkClient() = default;
  virtual FGuid AddSource(TSharedPtr<ILiveLinkSource> source) = 0;
  virtual void PushSubjectStaticData_AnyThread(const FLiveLinkSubjectKey& subject, UClass* role,
                                               FLiveLinkStaticDataStruct&& data) = 0;
  virtual void PushSubjectFrameData_AnyThread(const FLiveLinkSubjectKey& subject,
                                              FLiveLinkFrameDataStruct&& data) = 0;
  virtual void RemoveSubject_AnyThread(const FLiveLinkSubjectKey& subject) = 0;
};

// Plug-ins and files.
struct FPaths {
  static FString Combine(const FString& folder, const TCHAR* file) {
    return FString((std::filesystem::path(*folder) / file).c_str());
  }
  static FString ConvertRelativePathToFull(const FString& path) {
    return FString(std::filesystem::absolute(*path).c_str());
  }
  static bool FileExists(const FString& path) { return std::filesystem::exists(*path); }
};
class IPlugin {
 public:
  explicit IPlugin(FString base) : base_(std::move(base)) {}
  const FString& GetBaseDir() const { return base_; }

 private:
  FString base_;
};
class IPluginManager {
 public:
  static IPluginManager& Get() {
    static IPluginManager all;
    return all;
  }
  TSharedPtr<IPlugin> FindPlugin(const TCHAR* name) const {
    return std::string(name) == "DanceGraph" ? plugin : nullptr;
  }
  TSharedPtr<IPlugin> plugin;
};

// Modules and console commands: what the module's code is compiled against.
class IModularFeatures {
 public:
  static IModularFeatures& Get() {
    static IModularFeatures all;
    return all;
  }
  bool IsModularFeatureAvailable(const FName&) const { return client != nullptr; }
  template <class Feature>
  Feature& GetModularFeature(const FName&) {
    return *client;
  }
  ILiveLinkClient* client = nullptr;
};
struct IConsoleObject {};
struct FConsoleCommandWithArgsDelegate {
  using Function = void (*)(const TArray<FString>&);
  static FConsoleCommandWithArgsDelegate CreateStatic(Function function) { return {function}; }
  Function function;
};
class IConsoleManager {
 public:
  static IConsoleManager& Get() {
    static IConsoleManager all;
    return all;
  }
  IConsoleObject* RegisterConsoleCommand(const TCHAR*, const TCHAR*,
                                         const FConsoleCommandWithArgsDelegate& delegate) {
    command = delegate.function;
    return &object_;
  }
  void UnregisterConsoleObject(IConsoleObject*) { command = nullptr; }
  FConsoleCommandWithArgsDelegate::Function command = nullptr;

 private:
  IConsoleObject object_;
};
class IModuleInterface {
 public:
  virtual ~IModuleInterface() = default;
  virtual void StartupModule() {}
  virtual void ShutdownModule() {}
};
#define IMPLEMENT_MODULE(Module, Name) \
  std::unique_ptr<IModuleInterface> make_module_##Name() { return std::make_unique<Module>(); }
